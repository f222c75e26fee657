//! Functions of expressions.

super::vocabulary! {
    /// A function. In the IR angles are degrees, always.
    Func {
        /// Sine of an angle.
        Sin = "sin",
        /// Cosine of an angle.
        Cos = "cos",
        /// Tangent of an angle.
        Tan = "tan",
        /// Angle of a sine.
        Asin = "asin",
        /// Angle of a cosine.
        Acos = "acos",
        /// Angle of a tangent with one argument, -90 to 90; with two, the angle of the point (second, first), in the range the control uses.
        Atan = "atan",
        /// Square root.
        Sqrt = "sqrt",
        /// Absolute value.
        Abs = "abs",
        /// Nearest whole number, halves away from zero.
        Round = "round",
        /// Nearest multiple of the least increment of the address that it stands in.
        RoundIncrement = "round.increment",
        /// Nearest with so many decimal places: value, places.
        RoundPlaces = "round.places",
        /// Whole number, toward zero.
        Fix = "fix",
        /// Whole number, away from zero.
        Fup = "fup",
        /// -1 below zero, +1 at zero and above.
        Sign = "sign",
        /// Natural logarithm.
        Ln = "ln",
        /// e to a power.
        Exp = "exp",
        /// First argument to the power of the second.
        Pow = "pow",
        /// Binary-coded decimal to a number.
        Bin = "bin",
        /// Number to binary-coded decimal.
        Bcd = "bcd",
        /// Adds a decimal point: the value in least increments to the value in units.
        AddPoint = "adp",
        /// A parameter of the control: number, bit or axis.
        Parameter = "parameter",
    }
}

impl Func {
    /// How many arguments it takes.
    pub const fn arity(self) -> std::ops::RangeInclusive<usize> {
        match self {
            Func::Atan | Func::Parameter => 1..=2,
            Func::RoundPlaces | Func::Pow => 2..=2,
            _ => 1..=1,
        }
    }
}

//! Values and conditions, before a dialect spells them.

/// A value.
#[derive(Clone, Debug)]
pub enum Value {
    Number(f64),
    Slot(usize),
    /// A variable that is always empty; 0 where the dialect has none.
    Empty,
    Unary(Unary, Box<Value>),
    Binary(Binary, Box<Value>, Box<Value>),
}

impl Value {
    /// The first variable in it.
    pub fn slot(&self) -> Option<usize> {
        match self {
            Value::Number(_) | Value::Empty => None,
            Value::Slot(slot) => Some(*slot),
            Value::Unary(_, a) => a.slot(),
            Value::Binary(_, a, b) => a.slot().or(b.slot()),
        }
    }
}

/// A function of one value. What is not defined everywhere is spelled so that it is: the root is that of a
/// square and one more, tangents are of the arc tangent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    Negate,
    Abs,
    Sine,
    Cosine,
    ArcTangent,
    Root,
    Fix,
    Up,
    Round,
}

/// An operation on two values. The divisor of a division or remainder is drawn as a number that is not 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    And,
    Or,
    Xor,
    /// The arc tangent of a quotient, quadrants kept.
    ArcTangent,
}

/// How two values are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    Equal,
    Unequal,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
}

impl Relation {
    pub const ALL: [Relation; 6] = [
        Relation::Equal,
        Relation::Unequal,
        Relation::Less,
        Relation::LessEqual,
        Relation::Greater,
        Relation::GreaterEqual,
    ];

    /// What holds where this does not.
    pub fn opposite(self) -> Self {
        match self {
            Relation::Equal => Relation::Unequal,
            Relation::Unequal => Relation::Equal,
            Relation::Less => Relation::GreaterEqual,
            Relation::LessEqual => Relation::Greater,
            Relation::Greater => Relation::LessEqual,
            Relation::GreaterEqual => Relation::Less,
        }
    }

    /// In two letters, as most controls write it.
    pub fn letters(self) -> &'static str {
        ["EQ", "NE", "LT", "LE", "GT", "GE"][self as usize]
    }

    /// In signs.
    pub fn signs(self) -> &'static str {
        ["=", "<>", "<", "<=", ">", ">="][self as usize]
    }
}

/// A condition.
#[derive(Clone, Debug)]
pub enum Test {
    Compare(Relation, Value, Value),
    /// A variable is empty, or is not.
    Empty(usize, bool),
    Both(Box<Test>, Box<Test>),
    Either(Box<Test>, Box<Test>),
}

impl Test {
    /// What holds where this does not.
    pub fn opposite(&self) -> Test {
        match self {
            Test::Compare(relation, a, b) => Test::Compare(relation.opposite(), a.clone(), b.clone()),
            Test::Empty(slot, empty) => Test::Empty(*slot, !empty),
            Test::Both(a, b) => Test::Either(Box::new(a.opposite()), Box::new(b.opposite())),
            Test::Either(a, b) => Test::Both(Box::new(a.opposite()), Box::new(b.opposite())),
        }
    }

    /// The variables that it looks at by themselves.
    pub fn given(&self) -> Vec<usize> {
        match self {
            Test::Compare(_, left, _) => left.slot().into_iter().collect(),
            Test::Empty(slot, _) => vec![*slot],
            Test::Both(a, b) | Test::Either(a, b) => [a.given(), b.given()].concat(),
        }
    }
}

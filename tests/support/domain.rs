/// The operands that tell rewritings apart: vacant, zeros, halves, wholes, near misses, the least and the greatest.
pub const DOMAIN: [Option<f64>; 13] = [
    None,
    Some(0.0),
    Some(-0.0),
    Some(0.5),
    Some(-0.5),
    Some(1.0),
    Some(-1.0),
    Some(1.5),
    Some(2.5),
    Some(0.4999999),
    Some(359.9),
    Some(1e-9),
    Some(99_999_999.0),
];

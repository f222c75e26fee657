//! Finishing passes, run-out and angle of a thread, which some controls take as one number of six digits.
//!
//! Law: `mmrraa` is m finishing passes, a run-out of rr tenths of the lead, and the angle aa. Side condition: a constant, whose
//! parts have two digits each. Counter-example: a run-out of 0.25 leads, which has no digits.

use crate::canon::Role;
use crate::ir::Expr;

/// The parts of a thread's form, in the order of their digits.
pub(super) const PARTS: [Role; 3] = [Role::ThreadFinishes, Role::ThreadRunOut, Role::ThreadAngle];

/// Takes the number apart; false where it is computed or has other digits.
pub fn apart(values: &mut Vec<(Role, Expr)>) -> bool {
    let Some(at) = values.iter().position(|(role, _)| *role == Role::ThreadForm) else { return true };
    let form = values[at].1.constant().filter(|form| form.fract() == 0.0 && (0.0..1e6).contains(form));
    let Some(form) = form else { return false };
    values.remove(at);
    let digits = [form / 10_000.0, form / 100.0 % 100.0, form % 100.0].map(f64::trunc);
    let parts = [digits[0], digits[1] / 10.0, digits[2]];
    values.extend(PARTS.into_iter().zip(parts.map(Expr::Number)));
    true
}

/// Makes one number of the parts; false where a part is computed or does not fit.
pub fn together(values: &mut Vec<(Role, Expr)>) -> bool {
    let part = |role: Role| match values.iter().find(|(found, _)| *found == role) {
        Some((_, value)) => value.constant(),
        None => Some(0.0),
    };
    let Some(parts) = PARTS.iter().map(|role| part(*role)).collect::<Option<Vec<f64>>>() else {
        return false;
    };
    let digits = [parts[0], (parts[1] * 1e7).round() / 1e6, parts[2]];
    if digits.iter().any(|digits| digits.fract() != 0.0 || !(0.0..100.0).contains(digits)) {
        return false;
    }
    values.retain(|(role, _)| !PARTS.contains(role));
    values.push((Role::ThreadForm, Expr::Number(digits[0] * 10_000.0 + digits[1] * 100.0 + digits[2])));
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The digits are those of the maker's example: two finishing passes, a run-out of one lead, 60 degrees.
    #[test]
    fn a_form_is_its_parts() {
        let mut values = vec![(Role::ThreadForm, Expr::Number(21_060.0))];
        assert!(apart(&mut values));
        let parts = [(PARTS[0], 2.0), (PARTS[1], 1.0), (PARTS[2], 60.0)];
        assert_eq!(values, parts.map(|(role, value)| (role, Expr::Number(value))).to_vec());
        assert!(together(&mut values));
        assert_eq!(values, [(Role::ThreadForm, Expr::Number(21_060.0))]);
    }

    #[test]
    fn what_has_no_digits_is_no_form() {
        for parts in [[1.0, 0.25, 60.0], [1.0, 1.0, 29.5], [100.0, 0.0, 60.0], [1.0, 10.0, 60.0]] {
            let mut values: Vec<(Role, Expr)> = PARTS.into_iter().zip(parts.map(Expr::Number)).collect();
            assert!(!together(&mut values), "{parts:?}");
        }
        assert!(!apart(&mut vec![(Role::ThreadForm, Expr::Number(0.5))]));
        assert!(!apart(&mut vec![(Role::ThreadForm, Expr::Vacant)]));
    }
}

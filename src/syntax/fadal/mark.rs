//! The `#` before a macro statement.

/// Where the macro statement of a line begins: the offset of its `#`.
pub(super) fn mark_of(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut at = 0;
    let skip = |at: &mut usize, test: fn(&u8) -> bool| {
        *at += bytes.iter().skip(*at).take_while(|byte| test(byte)).count();
    };
    let blank: fn(&u8) -> bool = |byte| matches!(byte, b' ' | b'\t');
    for sign in [b'/', b'N', b'/'] {
        skip(&mut at, blank);
        if bytes.get(at).is_some_and(|byte| byte.eq_ignore_ascii_case(&sign)) {
            at += 1;
            skip(&mut at, blank);
            skip(&mut at, u8::is_ascii_digit);
        }
    }
    skip(&mut at, blank);
    (bytes.get(at) == Some(&b'#')).then_some(at)
}

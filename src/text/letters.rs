//! Letters outside ASCII: how bytes are read, and what stands for a letter on a control that lacks it.

use std::borrow::Cow;

/// The text of bytes: UTF-8 where they are that, else the one-byte code of Windows, of which Latin-1 is a part. No
/// byte is lost.
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().map(|&byte| windows(byte)).collect()),
    }
}

/// A character of Windows-1252; the five bytes that it leaves free are signs that no control has.
fn windows(byte: u8) -> char {
    const HIGH: &str = "€\u{FFFD}‚ƒ„…†‡ˆ‰Š‹Œ\u{FFFD}Ž\u{FFFD}\u{FFFD}‘’“”•–—˜™š›œ\u{FFFD}žŸ";
    match byte {
        0x80..=0x9F => HIGH.chars().nth(usize::from(byte - 0x80)).unwrap_or('\u{FFFD}'),
        _ => char::from(byte),
    }
}

/// What stands in ASCII for a character outside it, so that a reader takes it for the same; none if nothing does.
pub fn likeness(c: char) -> Option<&'static str> {
    Some(match c {
        'Ä' | 'Æ' => "AE",
        'ä' | 'æ' => "ae",
        'Ö' | 'Œ' => "OE",
        'ö' | 'œ' => "oe",
        'Ü' => "UE",
        'ü' => "ue",
        'ß' => "ss",
        'À' | 'Á' | 'Â' | 'Ã' | 'Å' | 'Ą' => "A",
        'à' | 'á' | 'â' | 'ã' | 'å' | 'ą' => "a",
        'Ç' | 'Ć' | 'Č' => "C",
        'ç' | 'ć' | 'č' => "c",
        'È' | 'É' | 'Ê' | 'Ë' | 'Ę' | 'Ě' => "E",
        'è' | 'é' | 'ê' | 'ë' | 'ę' | 'ě' => "e",
        'Ì' | 'Í' | 'Î' | 'Ï' | 'İ' => "I",
        'ì' | 'í' | 'î' | 'ï' | 'ı' => "i",
        'Ł' => "L",
        'ł' => "l",
        'Ñ' | 'Ń' | 'Ň' => "N",
        'ñ' | 'ń' | 'ň' => "n",
        'Ò' | 'Ó' | 'Ô' | 'Õ' | 'Ø' | 'Ő' => "O",
        'ò' | 'ó' | 'ô' | 'õ' | 'ø' | 'ő' => "o",
        'Ř' => "R",
        'ř' => "r",
        'Ś' | 'Š' | 'Ş' => "S",
        'ś' | 'š' | 'ş' => "s",
        'Ù' | 'Ú' | 'Û' | 'Ů' | 'Ű' => "U",
        'ù' | 'ú' | 'û' | 'ů' | 'ű' => "u",
        'Ý' | 'Ÿ' => "Y",
        'ý' | 'ÿ' => "y",
        'Ź' | 'Ż' | 'Ž' => "Z",
        'ź' | 'ż' | 'ž' => "z",
        '°' | 'º' => " DEG",
        '±' => "+/-",
        'µ' | 'μ' => "u",
        '×' => "x",
        '⌀' => "DIA",
        '€' => "EUR",
        '½' => "1/2",
        '¼' => "1/4",
        '¾' => "3/4",
        '²' => "2",
        '³' => "3",
        '…' => "...",
        '–' | '—' | '‐' | '‑' | '−' => "-",
        '‘' | '’' | '‚' => "'",
        '“' | '”' | '„' | '«' | '»' => "\"",
        '\u{A0}' | '\u{2028}' | '\u{2029}' | '\u{2000}'..='\u{200A}' | '\u{202F}' => " ",
        // An accent that follows its letter, and signs without a width.
        '\u{300}'..='\u{36F}' | '\u{AD}' | '\u{200B}'..='\u{200D}' | '\u{FEFF}' => "",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_read_as_they_were_written() {
        assert_eq!(decode("TÜR".as_bytes()), "TÜR");
        assert_eq!(decode(b"T\xDCR AUF"), "TÜR AUF");
        assert_eq!(decode(b"5 \x96 10 \x80 \x93A\x94 \x81"), "5 – 10 € “A” \u{FFFD}");
        assert_eq!(decode(b"fa\xE7ade"), "façade");
        let all: Vec<u8> = (0..=255).collect();
        assert_eq!(decode(&all).chars().count(), 256);
    }

    #[test]
    fn what_stands_for_a_letter_is_ascii() {
        for c in ('\u{80}'..'\u{3000}').filter_map(likeness) {
            assert!(c.is_ascii(), "{c}");
        }
        assert_eq!(('Ü', likeness('Ü'), likeness('日')), ('Ü', Some("UE"), None));
    }
}

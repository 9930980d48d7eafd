//! Bytes to text, whatever encoding an instrument or a spreadsheet has chosen.

use std::borrow::Cow;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// So much of a file without a mark is looked at for the zeros of UTF-16, bytes.
const LOOKED_AT: usize = 4096;

/// Text and how it was encoded.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded<'a> {
    /// The text, without a byte order mark.
    pub text: Cow<'a, str>,
    /// Name of the encoding as the web knows it: `UTF-8`, `UTF-16LE`, `windows-1252`.
    pub encoding: &'static str,
}

/// By its mark, else by its zeros, else UTF-8 if it is, else what Western Windows programs write. `asked` overrules all.
pub fn decode<'a>(bytes: &'a [u8], asked: Option<&str>) -> Option<Decoded<'a>> {
    let encoding = match asked {
        Some(label) => Encoding::for_label(label.as_bytes())?,
        None => guess(bytes),
    };
    let (text, encoding, _) = encoding.decode(bytes);
    Some(Decoded { text, encoding: encoding.name() })
}

fn guess(bytes: &[u8]) -> &'static Encoding {
    if let Some((encoding, _)) = Encoding::for_bom(bytes) {
        return encoding;
    }
    let first = &bytes[..bytes.len().min(LOOKED_AT)];
    let zeros = |offset: usize| first.iter().skip(offset).step_by(2).filter(|&&byte| byte == 0).count();
    let (even, odd, enough) = (zeros(0), zeros(1), first.len() / 5);
    if first.len() >= 8 && odd > enough && odd > 4 * even {
        UTF_16LE
    } else if first.len() >= 8 && even > enough && even > 4 * odd {
        UTF_16BE
    } else if std::str::from_utf8(bytes).is_ok() {
        UTF_8
    } else {
        WINDOWS_1252
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(bytes: &[u8]) -> (String, &'static str) {
        let Decoded { text, encoding } = decode(bytes, None).unwrap();
        (text.into_owned(), encoding)
    }

    #[test]
    fn marks_zeros_and_umlauts_tell() {
        let utf_16: Vec<u8> = "Zeit;Feld\n1;2\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(decoded(&utf_16), ("Zeit;Feld\n1;2\n".into(), "UTF-16LE"));
        let swapped: Vec<u8> = "Zeit;Feld\n1;2\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(decoded(&swapped), ("Zeit;Feld\n1;2\n".into(), "UTF-16BE"));
        assert_eq!(decoded(b"\xef\xbb\xbftime\n"), ("time\n".into(), "UTF-8"));
        assert_eq!(decoded(b"Temp [\xb0C]\n"), ("Temp [\u{b0}C]\n".into(), "windows-1252"));
        assert_eq!(decoded("Temp [\u{b0}C]\n".as_bytes()), ("Temp [\u{b0}C]\n".into(), "UTF-8"));
        assert_eq!(decoded(b""), (String::new(), "UTF-8"));
    }

    #[test]
    fn an_encoding_can_be_asked_for() {
        assert_eq!(decode(b"\xe4", Some("latin1")).unwrap().text, "\u{e4}");
        assert_eq!(decode(b"a", Some("no such")), None);
    }
}

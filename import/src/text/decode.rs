//! Bytes to text, whatever encoding an instrument or a spreadsheet has chosen.

use std::borrow::Cow;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// So much of a file without a mark is looked at for the zeros of UTF-16, bytes.
const LOOKED_AT: usize = 4096;

/// Text and how it was encoded.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Decoded<'a> {
    /// The text, without a byte order mark.
    pub(crate) text: Cow<'a, str>,
    /// Name of the encoding as the web knows it: `UTF-8`, `UTF-16LE`, `windows-1252`.
    pub(crate) encoding: &'static str,
}

/// By its mark, else by its zeros, else UTF-8 if it is, else what Western Windows programs write. `asked` overrules all.
pub(crate) fn decode<'a>(bytes: &'a [u8], asked: Option<&str>) -> Option<Decoded<'a>> {
    let encoding = match asked {
        Some(label) => Encoding::for_label(label.as_bytes())?,
        None => guess(bytes),
    };
    let (text, encoding, _) = encoding.decode(bytes);
    Some(Decoded { text: with_usual_ends(without_end_mark(text)), encoding: encoding.name() })
}

/// The text of a file, whatever its encoding.
pub(crate) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    // No encoding is asked for: one is always found.
    decode(bytes, None).map(|decoded| decoded.text).unwrap_or_default()
}

/// Without what DOS puts behind the last line.
fn without_end_mark(text: Cow<'_, str>) -> Cow<'_, str> {
    let end = text.trim_end_matches('\u{1a}').len();
    match text {
        Cow::Borrowed(text) => Cow::Borrowed(&text[..end]),
        Cow::Owned(mut text) => {
            text.truncate(end);
            Cow::Owned(text)
        }
    }
}

/// Each `\r` that ends a line alone becomes a `\n`: lines are then counted alike by all readers.
fn with_usual_ends(text: Cow<'_, str>) -> Cow<'_, str> {
    let bytes = text.as_bytes();
    let is_alone = |at: usize| !matches!(bytes[at + 1..], [b'\n', ..] | [b'\r', b'\n', ..]);
    let mut alone = text.match_indices('\r').map(|(at, _)| at).filter(|at| is_alone(*at)).peekable();
    if alone.peek().is_none() {
        return text;
    }
    let (mut usual, mut begin) = (String::with_capacity(text.len()), 0);
    for at in alone {
        usual.push_str(&text[begin..at]);
        usual.push('\n');
        begin = at + 1;
    }
    usual.push_str(&text[begin..]);
    Cow::Owned(usual)
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

    fn read(bytes: &[u8]) -> (String, &'static str) {
        let Decoded { text, encoding } = decode(bytes, None).unwrap();
        (text.into_owned(), encoding)
    }

    #[test]
    fn marks_zeros_and_umlauts_tell() {
        let utf_16: Vec<u8> = "Zeit;Feld\n1;2\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(read(&utf_16), ("Zeit;Feld\n1;2\n".into(), "UTF-16LE"));
        let swapped: Vec<u8> = "Zeit;Feld\n1;2\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(read(&swapped), ("Zeit;Feld\n1;2\n".into(), "UTF-16BE"));
        assert_eq!(read(b"\xef\xbb\xbftime\n"), ("time\n".into(), "UTF-8"));
        assert_eq!(read(b"Temp [\xb0C]\n"), ("Temp [\u{b0}C]\n".into(), "windows-1252"));
        assert_eq!(read("Temp [\u{b0}C]\n".as_bytes()), ("Temp [\u{b0}C]\n".into(), "UTF-8"));
        assert_eq!(read(b""), (String::new(), "UTF-8"));
    }

    #[test]
    fn lines_end_in_one_way() {
        assert_eq!(read(b"a\r\rb\r").0, "a\n\nb\n");
        assert_eq!(read(b"a\r\nb\rc\n\nd\x1a").0, "a\r\nb\nc\n\nd");
        let text = "a\r\nb\r\r\n";
        assert!(matches!(decode(text.as_bytes(), None).unwrap().text, Cow::Borrowed(same) if same == text));
    }

    #[test]
    fn an_encoding_can_be_asked_for() {
        assert_eq!(decode(b"\xe4", Some("latin1")).unwrap().text, "\u{e4}");
        assert_eq!(decode(b"a", Some("no such")), None);
    }
}

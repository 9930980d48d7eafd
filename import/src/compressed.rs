//! Files that come compressed.

use std::io::Read;

use flate2::read::MultiGzDecoder;

use crate::error::ImportError;
/// Text of readings shrinks to a third or a sixth of itself; what comes out of a file may be so many times its size. The table
/// of a text takes five times the text, so that a megabyte ends below 64.
const LARGEST_GROWTH: usize = 10;
/// What is always allowed to come out of a compressed file, bytes.
const ALWAYS_ALLOWED: usize = 8 << 20;

/// Whether these are the first bytes of a gzip, RFC 1952: two tell.
pub fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// What a file holds, decompressed if it is a gzip. One that is cut gives what it has, and says so.
///
/// # Errors
///
/// When it expands more than any recording does, or is damaged from the first byte on.
pub fn expand(file: &str, bytes: Vec<u8>) -> Result<(Vec<u8>, Option<String>), ImportError> {
    if !is_gzip(&bytes) {
        return Ok((bytes, None));
    }
    let most = (bytes.len().saturating_mul(LARGEST_GROWTH)).max(ALWAYS_ALLOWED);
    let mut expanded = Vec::new();
    let outcome = MultiGzDecoder::new(bytes.as_slice()).take(most as u64 + 1).read_to_end(&mut expanded);
    if expanded.len() > most {
        let what = format!(
            "expands to more than {LARGEST_GROWTH} times its size: no recording does; expand it yourself if it is one"
        );
        return Err(ImportError::file(file, what));
    }
    match outcome {
        Ok(_) => Ok((expanded, None)),
        Err(error) if expanded.is_empty() => {
            Err(ImportError::file(file, format!("is a damaged gzip ({error}): copy it again from where it came")))
        }
        Err(error) => {
            let note = format!("the gzip is cut or damaged ({error}): what comes before it was taken");
            Ok((expanded, Some(note)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn whole_cut_and_hostile_ones() {
        let text: Vec<u8> = (0..20_000).flat_map(|row| format!("{row},{}\n", row * 7919 % 1000).into_bytes()).collect();
        let packed = gzip(&text);
        assert_eq!(expand("a.gz", packed.clone()).unwrap(), (text.clone(), None));
        let (begin, note) = expand("a.gz", packed[..packed.len() / 2].to_vec()).unwrap();
        assert!(text.starts_with(&begin) && !begin.is_empty() && note.is_some());
        let bomb = gzip(&vec![0; 64 << 20]);
        assert!(expand("a.gz", bomb).unwrap_err().to_string().contains("times its size"));
        assert!(expand("a.gz", vec![0x1f, 0x8b, 1, 2]).unwrap_err().to_string().contains("copy it again"));
        assert_eq!(expand("a.csv", b"a,b".to_vec()).unwrap(), (b"a,b".to_vec(), None));
    }
}

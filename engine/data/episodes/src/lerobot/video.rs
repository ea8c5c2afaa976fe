//! Video files without decoding: whether they are whole, and their stated length.

use cosfly_diagnose::counted;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Largest `moov` that is read, bytes.
const MOOV_LIMIT: u64 = 1 << 28;

/// Length of an MP4 file in seconds.
///
/// # Errors
/// A text, where the file cannot be read or is cut.
pub fn seconds(path: &Path) -> Result<f64, String> {
    let mut file = File::open(path).map_err(|error| error.to_string())?;
    let end = file.metadata().map_err(|error| error.to_string())?.len();
    let (mut at, mut found) = (0, None);
    while at < end {
        let mut head = [0; 16];
        let length = head.len().min(usize::try_from(end - at).unwrap_or(usize::MAX));
        file.seek(SeekFrom::Start(at))
            .and_then(|_| file.read_exact(&mut head[..length]))
            .map_err(|it| it.to_string())?;
        if length < 8 {
            return Err(format!("it ends within a box at byte {at}"));
        }
        let (kind, size, header) = head_of(&head, end - at);
        if size < header || size > end - at {
            return Err(format!(
                "it is cut: its box `{kind}` at byte {at} has {size}, {} are there",
                end - at,
                size = counted(size, "byte")
            ));
        }
        if kind == "moov" {
            if size > MOOV_LIMIT {
                return Err(format!("its index has {size}", size = counted(size, "byte")));
            }
            let mut body = vec![0; (size - header) as usize];
            let read = file.seek(SeekFrom::Start(at + header)).and_then(|_| file.read_exact(&mut body));
            read.map_err(|error| error.to_string())?;
            found = longest(&body);
        }
        at += size;
    }
    found.ok_or_else(|| "it has no index of frames: it is not an MP4 file or is unfinished".to_owned())
}

/// Kind, size and length of the head of a box.
fn head_of(head: &[u8; 16], rest: u64) -> (String, u64, u64) {
    let kind = String::from_utf8_lossy(&head[4..8]).into_owned();
    match u32::from_be_bytes([head[0], head[1], head[2], head[3]]) {
        0 => (kind, rest, 8),
        1 => {
            let [_, _, _, _, _, _, _, _, size @ ..] = *head;
            (kind, u64::from_be_bytes(size), 16)
        }
        size => (kind, u64::from(size), 8),
    }
}

/// Length of the longest track by its `mdhd`, seconds.
fn longest(moov: &[u8]) -> Option<f64> {
    let mut longest: Option<f64> = None;
    for (kind, trak) in boxes(moov) {
        if kind != *b"trak" {
            continue;
        }
        let media = boxes(trak).into_iter().filter(|it| it.0 == *b"mdia").flat_map(|it| boxes(it.1));
        for (_, header) in media.filter(|it| it.0 == *b"mdhd") {
            longest = duration(header).map_or(longest, |it| Some(longest.map_or(it, |other| other.max(it))));
        }
    }
    longest
}

fn duration(mdhd: &[u8]) -> Option<f64> {
    let word = |at: usize| Some(u32::from_be_bytes(mdhd.get(at..at + 4)?.try_into().ok()?));
    let (scale, duration) = if *mdhd.first()? == 1 {
        (word(20)?, (u64::from(word(24)?) << 32) + u64::from(word(28)?))
    } else {
        (word(12)?, u64::from(word(16)?))
    };
    (scale > 0).then(|| duration as f64 / f64::from(scale))
}

/// The boxes in a box, without those that do not fit.
fn boxes(mut bytes: &[u8]) -> Vec<([u8; 4], &[u8])> {
    let mut found = vec![];
    while let Some((head, _)) = bytes.split_first_chunk::<8>() {
        let [a, b, c, d, kind @ ..] = *head;
        let size = u32::from_be_bytes([a, b, c, d]) as usize;
        let Some(body) = bytes.get(8..size) else { break };
        found.push((kind, body));
        bytes = &bytes[size..];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxed(kind: &str, body: &[u8]) -> Vec<u8> {
        [&(body.len() as u32 + 8).to_be_bytes()[..], kind.as_bytes(), body].concat()
    }

    fn checked(bytes: &[u8]) -> Result<f64, String> {
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), bytes).expect("written");
        seconds(file.path())
    }

    #[test]
    fn the_length_is_that_of_the_media_header_and_cuts_are_named() {
        let mdhd = [[0; 4], [0; 4], [0; 4], 600_u32.to_be_bytes(), 1500_u32.to_be_bytes()].concat();
        let moov = boxed("moov", &boxed("trak", &boxed("mdia", &boxed("mdhd", &mdhd))));
        let whole = [boxed("ftyp", b"isom"), boxed("mdat", &[7; 100]), moov].concat();
        assert_eq!(checked(&whole), Ok(2.5));
        assert!(checked(&whole[..whole.len() - 9]).is_err_and(|it| it.contains("cut")));
        assert!(checked(&whole[..60]).is_err_and(|it| it.contains("`mdat`")));
        assert!(checked(&whole[..120]).is_err_and(|it| it.contains("index")));
        assert!(checked(&[]).is_err());
        assert!(checked(&[1, 2, 3]).is_err());
        assert!(checked(&[0, 0, 0, 1, 1, 1, 1, 1]).is_err());
    }
}

//! Choice of the frames of a flight.

use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use std::collections::BTreeSet;
use std::str::FromStr;

/// A list of frames and ranges, such as `0,50,100` or `0..200:10`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameList(Vec<Part>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct Part {
    first: usize,
    /// Behind the last.
    end: usize,
    step: usize,
}

impl FromStr for FrameList {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split(',').map(|part| Part::read(part.trim())).collect::<Result<_, _>>().map(Self)
    }
}

impl Part {
    fn read(text: &str) -> Result<Self, String> {
        let number = |text: &str| {
            let frame = text.trim().parse::<u32>().map(|number| number as usize);
            frame.map_err(|_| format!("`{text}` is not a frame; write frames as `0,50,100` or as a range `0..200:10`"))
        };
        let Some((first, rest)) = text.split_once("..") else {
            let first = number(text)?;
            return Ok(Self { first, end: first + 1, step: 1 });
        };
        let (end, step) = rest.split_once(':').unwrap_or((rest, "1"));
        let part = Self { first: number(first)?, end: number(end)?, step: number(step)? };
        match part {
            Self { step: 0, .. } => Err(format!("`{text}` has a step of 0; it must be at least 1")),
            Self { first, end, .. } if end <= first => {
                Err(format!("`{text}` is empty: a range ends before its second number, which must be larger"))
            }
            part => Ok(part),
        }
    }
}

impl FrameList {
    /// The frames in order, of a flight called `name` that has `frames` frames.
    ///
    /// # Errors
    /// `preview-frame` when one lies beyond its end.
    pub fn of(&self, name: &str, frames: usize) -> Result<Vec<usize>> {
        let mut chosen = BTreeSet::new();
        for part in &self.0 {
            if let Some(missing) = (part.first..part.end).step_by(part.step).find(|frame| *frame >= frames) {
                let message = format!("`{name}` has no frame {missing}: it has {}, from 0", counted(frames, "frame"));
                return Err(Diagnostic::new("preview-frame", Fault::Recipe, message)
                    .hint(format!("frames go from 0 to {}; all of them are `0..{frames}`", frames.saturating_sub(1))));
            }
            chosen.extend((part.first..part.end).step_by(part.step));
        }
        Ok(chosen.into_iter().collect())
    }
}

/// `count` of `frames` frames, evenly spread, first and last among them; all of them when there are fewer.
pub fn spread(frames: usize, count: usize) -> Vec<usize> {
    match (frames, count) {
        (0, _) | (_, 0) => vec![],
        (_, 1) => vec![0],
        _ if frames <= count => (0..frames).collect(),
        _ => (0..count).map(|i| i * (frames - 1) / (count - 1)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(text: &str) -> Vec<usize> {
        text.parse::<FrameList>().unwrap().of("a", 201).unwrap()
    }

    #[test]
    fn lists_and_ranges_are_read() {
        assert_eq!(chosen("0,50,100"), [0, 50, 100]);
        assert_eq!(chosen("0..200:50, 7, 7"), [0, 7, 50, 100, 150]);
        assert_eq!(chosen("198..201"), [198, 199, 200]);
        assert_eq!(chosen("0..250:100"), [0, 100, 200]);
    }

    #[test]
    fn nonsense_is_refused_in_words() {
        for (text, words) in [("x", "not a frame"), ("", "not a frame"), ("5..2", "is empty"), ("0..9:0", "step of 0")]
        {
            assert!(text.parse::<FrameList>().unwrap_err().contains(words), "{text}");
        }
        let error = "5,201".parse::<FrameList>().unwrap().of("expert-p00000", 201).unwrap_err();
        assert!(error.message.contains("`expert-p00000` has no frame 201") && error.hints[0].contains("0 to 200"));
        let first = |text: &str| text.parse::<FrameList>().unwrap().of("a", 24).unwrap_err().message;
        assert_eq!(first("0..99"), "`a` has no frame 24: it has 24 frames, from 0");
        assert_eq!(first("3..99:10"), "`a` has no frame 33: it has 24 frames, from 0");
        assert!("0..4000000000".parse::<FrameList>().unwrap().of("a", 9).is_err());
    }

    #[test]
    fn spread_frames_include_both_ends() {
        assert_eq!(spread(201, 5), [0, 50, 100, 150, 200]);
        assert_eq!((spread(3, 6), spread(0, 6), spread(9, 1)), (vec![0, 1, 2], vec![], vec![0]));
    }
}

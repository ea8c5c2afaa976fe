//! Left, middle and right of a picture: one definition for all texts.

/// Shares of the picture's width: left of the first is the left, right of the last the right, the middle between the others. Between
/// left and middle, and middle and right, nobody can say which it is.
const PARTS: [f64; 4] = [0.3, 0.4, 0.6, 0.7];

/// Part of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum PicturePart {
    Left,
    Middle,
    Right,
}

impl PicturePart {
    /// The part of what has its middle at this share of the picture's width; `None` near a border of parts.
    pub fn at(across: f64) -> Option<Self> {
        let [left, from, to, right] = PARTS;
        match across {
            it if it < left => Some(Self::Left),
            it if (from..=to).contains(&it) => Some(Self::Middle),
            it if it > right => Some(Self::Right),
            _ => None,
        }
    }

    /// Selector in messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Middle => "middle",
            Self::Right => "right",
        }
    }
}

//! Names of colours, and [`Dye`]: a colour with its light.

use serde::{Deserialize, Serialize};

/// Colour of a piece of clothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dye {
    /// Name of the colour.
    pub name: Colour,
    /// Reflected share of light, linear RGB.
    pub linear_rgb: [f32; 3],
}

/// Names of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Colour {
    Black,
    Grey,
    White,
    Red,
    Orange,
    Yellow,
    Green,
    Blue,
    Purple,
    Pink,
    Brown,
    Beige,
}

impl Colour {
    /// All names.
    pub const ALL: [Self; 12] = [
        Self::Black,
        Self::Grey,
        Self::White,
        Self::Red,
        Self::Orange,
        Self::Yellow,
        Self::Green,
        Self::Blue,
        Self::Purple,
        Self::Pink,
        Self::Brown,
        Self::Beige,
    ];

    /// The name in tables and in English texts.
    pub fn name(self) -> &'static str {
        match self {
            Self::Black => "black",
            Self::Grey => "grey",
            Self::White => "white",
            Self::Red => "red",
            Self::Orange => "orange",
            Self::Yellow => "yellow",
            Self::Green => "green",
            Self::Blue => "blue",
            Self::Purple => "purple",
            Self::Pink => "pink",
            Self::Brown => "brown",
            Self::Beige => "beige",
        }
    }
}

pub(crate) const fn dye(name: Colour, linear_rgb: [f32; 3]) -> Dye {
    Dye { name, linear_rgb }
}

//! Looks of a person: colours of clothes, bag, build, gait.

use serde::{Deserialize, Serialize};

/// Bag of a person.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Bag {
    None,
    Backpack,
    Shoulder,
}

/// Build of a person.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum BodyBuild {
    Slim,
    Medium,
    Stout,
}

/// Steps of a person: how far the legs swing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Gait {
    Short,
    Medium,
    Long,
}

/// Properties of a person's looks beside the clothes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Traits {
    /// Bag.
    pub bag: Bag,
    /// Build.
    pub build: BodyBuild,
    /// Gait.
    pub gait: Gait,
}

impl Traits {
    /// No bag, medium build and gait.
    pub const PLAIN: Self = Self { bag: Bag::None, build: BodyBuild::Medium, gait: Gait::Medium };
}

impl Bag {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Backpack => "backpack",
            Self::Shoulder => "shoulder_bag",
        }
    }
}

impl BodyBuild {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slim => "slim",
            Self::Medium => "medium",
            Self::Stout => "stout",
        }
    }
}

impl Gait {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Short => "short",
            Self::Medium => "medium",
            Self::Long => "long",
        }
    }
}

/// Clothes as people name them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outfit {
    /// Shirt or jacket.
    pub top: Dye,
    /// Trousers.
    pub trousers: Dye,
    /// Wears a backpack.
    pub backpack: bool,
    /// Holds an open umbrella.
    pub umbrella: bool,
    /// Bag, build and gait; `None` for vehicles and their riders.
    pub traits: Option<Traits>,
}

impl Outfit {
    /// Whether two people are dressed alike in words: colours of top and trousers, a backpack or none.
    pub fn is_like(&self, other: &Self) -> bool {
        let words = |it: &Self| (it.top.name, it.trousers.name, it.backpack);
        words(self) == words(other)
    }
}

/// Colour of a piece of clothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dye {
    /// Name of the colour.
    pub name: Colour,
    /// Reflected share of light, linear RGB.
    pub linear_rgb: [f32; 3],
}

impl Dye {
    /// A named colour and its light.
    pub const fn new(name: Colour, linear_rgb: [f32; 3]) -> Self {
        Self { name, linear_rgb }
    }
}

/// One row per colour: name in code, name in tables and in English texts.
macro_rules! colours {
    ($($colour:ident $name:literal;)*) => {
        /// Names of colours.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[expect(missing_docs, reason = "the names say it")]
        pub enum Colour {
            $($colour,)*
        }

        impl Colour {
            /// All names.
            pub const ALL: [Self; 12] = [$(Self::$colour),*];

            /// The name in tables and in English texts.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$colour => $name,)*
                }
            }
        }
    };
}

colours! {
    Black "black";
    Grey "grey";
    White "white";
    Red "red";
    Orange "orange";
    Yellow "yellow";
    Green "green";
    Blue "blue";
    Purple "purple";
    Pink "pink";
    Brown "brown";
    Beige "beige";
}

//! Typed facts of a trajectory, and Chinese and English instructions checked against them.
//!
//! [`facts`] reads a trajectory, [`captions`] puts the facts into words, [`check`] reads any text back and compares
//! it with the facts. The reader (`cosfly-claims`) shares no code with the templates; it judges what its lexicon has.
//!
//! [`part`] says what is the left, the middle and the right of a picture.
//!
//! [`refer`] names the target by properties that nobody else in a picture has.
//!
//! [`teaching`] puts the facts into questions to a language model, and judges what it writes; [`diversity`] and [`coverage`] measure texts.
//!
//! [`goals`] says what a pilot shall do at several grains: a flight, its steps, dialogues, and goals that do not fit.
//!
//! [`sight`] does the same for one picture: an instruction that singles the target out by what the picture shows.

pub mod caption;
pub mod check;
pub mod config;
pub mod coverage;
mod description;
pub mod diversity;
pub mod facts;
mod facts_in_words;
pub mod goals;
mod instruction;
mod messages;
pub mod part;
pub mod precision;
pub mod refer;
pub mod sight;
pub mod teaching;
mod turns;
mod who;
mod wording;

pub use caption::{Caption, captions};
pub use check::{Slot, SlotMismatch, check, check_clothes, claimed};
pub use config::{CaptionConfig, Style, Writer};
pub use cosfly_claims::{Compass, Language, TurnKind};
pub use coverage::{Coverage, coverage};
pub use diversity::{Diversity, diversity};
pub use facts::{Facts, FirstTurn, LeftOut, TargetStop, Wear, facts};
pub use facts_in_words::facts_in_words;
pub use turns::Turn;

//! The schema of datasets: the record model, and every table, column and topic with name, type, unit and meaning.
//!
//! * [`record`]: one rendered trajectory, as passed between stages.
//! * [`config`]: parameters of the dataset as a whole.
//! * [`card_text`]: texts of the card with names for facts.
//! * [`tables`]: the Parquet tables and their columns.
//! * [`log`]: the topics and messages of a trajectory's MCAP log.
//! * [`mot_class`]: classes of MOTChallenge.
//! * [`town_layout`]: ground plan of a town, which identifies the town.
//! * [`flight_table`], [`extras`]: labels, tables and files of plugins; [`published_costs`]: costs of flights.

pub mod card_text;
pub mod config;
pub mod extras;
pub mod flight_table;
pub mod log;
pub mod losses;
pub mod mot_class;
pub mod published_costs;
pub mod record;
mod reference;
mod split;
mod split_config;
pub mod tables;
pub mod town_layout;

pub use config::{DatasetConfig, DepthEncoding, EncodingConfig, JpegChroma, RgbEncoding};
pub use record::{
    CaptionRecord, LogRecord, OtherBody, PairInfo, PreviewStrip, Rejection, RenderedTrajectory, Role, Sighting,
    TownInfo,
};
pub use reference::reference;
pub use split::Split;
pub use town_layout::TownLayout;

//! Closed-loop evaluation: a policy flies the episodes of a suite, and the result is a folder of scores and logs.
//!
//! * [`suite`]: the episodes of a recipe, with the experts' flights.
//! * [`benchmark`]: tiers that take episodes from several.
//! * [`held_out`]: suites that are committed to before they are known.
//! * [`settings`]: what a recipe says of the drone.
//! * [`pilot`]: policies: baselines, servers behind a WebSocket ([`wire`]), functions in Python, networks in ONNX files.
//! * [`flight`]: one episode, flown: its row and its steps ([`log`]).
//! * [`run`]: all episodes on several threads ([`crew`]), resumed where rows are there already.
//! * [`vector`]: many environments stepped together, for learners.
//! * [`experts`]: the experts of a recipe, asked again; [`dagger`]: what they say where a policy came.
//! * [`hunt`]: episodes in which a policy fails and the expert does not.
//! * [`results`]: the folder: card, rows, logs, tables with intervals; [`compare`]: two of them side by side.
//! * [`bundle`]: a result as one file; [`again`]: its actions, flown again, or its policy, run again.
//! * [`board`]: a folder of them as a leaderboard.
//! * [`pictures`]: logs that play in Foxglove, clips, the page.

pub mod again;
pub mod benchmark;
pub mod board;
pub mod bundle;
pub mod compare;
pub mod crew;
pub mod dagger;
pub mod experts;
pub mod flight;
pub mod held_out;
pub mod hunt;
pub mod log;
pub mod pictures;
pub mod pilot;
pub mod results;
pub mod run;
pub mod settings;
pub mod suite;
pub mod vector;
pub mod wire;

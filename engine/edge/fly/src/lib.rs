//! Closed-loop evaluation: a policy flies the episodes of a suite, and the result is a folder of scores and logs.
//!
//! * [`suite`]: the episodes of a recipe, with the experts' flights.
//! * [`pilot`]: policies: baselines, servers behind a WebSocket ([`wire`]), functions in Python.
//! * [`flight`]: one episode, flown: its row and its log.
//! * [`run`]: all episodes on several threads, resumed where rows are there already.
//! * [`vector`]: many environments stepped together, for learners.
//! * [`results`]: the folder: card, rows, logs, tables with intervals; [`compare`]: two of them side by side.

pub mod compare;
pub mod flight;
pub mod pilot;
pub mod results;
pub mod run;
pub mod suite;
pub mod vector;
pub mod wire;

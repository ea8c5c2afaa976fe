//! The host against plugins of every kind: good ones, hostile ones, damaged ones. All are written as text here.

mod border;
mod fixtures;
mod hostile;
mod laws;
mod stage_text;
mod stages;
mod working;

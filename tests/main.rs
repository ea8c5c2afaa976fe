//! End-to-end tests through the real binary: runs, resume, determinism, diagnostics, snapshots, repository rules.

mod advice;
mod ask_expert;
mod at_once;
mod benchmark;
mod book;
mod caching;
mod cameras;
mod carla_job;
#[cfg(unix)]
mod cluster;
mod codes;
mod container;
mod crash;
mod diagnostics;
mod doctor;
mod evaluation;
mod export;
mod fly;
mod fly_onnx;
mod fly_policies;
mod fuzzing;
mod hostile_maps;
mod house;
mod hunt;
mod leaderboard;
mod long_walks;
mod models;
mod more_walkers;
mod named_files;
mod people;
mod places;
#[cfg(feature = "plugins")]
mod plugins;
mod preview;
mod processors;
mod promises;
mod repository;
mod scans;
mod sensors;
mod several_towns;
mod shared;
mod snapshots;
mod steering;
mod street;
mod support;
mod towns;
mod traffic;
mod versions;
#[cfg(feature = "plugins")]
mod versions_held;
mod view;

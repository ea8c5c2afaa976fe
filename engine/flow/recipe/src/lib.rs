//! From TOML text to a checked DAG of stages.

//! The record model and its Parquet, MCAP, Croissant and card writers.

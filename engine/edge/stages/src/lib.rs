//! The built-in stages: thin adapters between the simulated world and the engine.

//! Laws of the engine, held on toy stages.

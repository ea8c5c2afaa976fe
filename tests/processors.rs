//! Equal bytes with all vector instructions of the processor.

use crate::street::Street;
use crate::support::{cosfly, tree_digests};
use cosfly_frames::simd::Level;

#[test]
fn every_vector_level_makes_the_same_dataset() {
    let made = |level: Level| {
        let street = Street::new();
        cosfly(&["run", "recipe.toml", "--quiet"]).with("COSFLY_SIMD", level.name()).within(street.path()).run_ok();
        tree_digests(&street.dataset())
    };
    let plain = made(Level::PLAIN);
    assert!(plain.len() > 5);
    for level in Level::available() {
        assert_eq!(made(level), plain, "{}", level.name());
    }
}

#[test]
fn a_vector_level_that_is_not_there_is_refused() {
    let printed = cosfly(&["plan", "recipe.toml"]).with("COSFLY_SIMD", "mmx").run();
    assert_eq!(printed.code, Some(2));
    assert!(printed.stderr.contains("COSFLY_SIMD is `mmx`; this processor has plain"), "{}", printed.stderr);
}

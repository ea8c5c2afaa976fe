//! Suites that nobody knows before they are revealed: a recipe whose seed comes from a nonce, and its digest, published first.
//!
//! The secret is the whole recipe. It holds the nonce, so that its digest tells nothing of it, and the hash of its suite, so that the
//! digest binds every episode.

use crate::suite::Suite;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;

/// Table of the recipe that holds nonce and hash.
const TABLE: &str = "commitment";

/// Random bits of the operating system.
pub type Nonce = [u8; 32];

/// Name and seed of the suite that a nonce makes of a recipe.
pub fn drawn(recipe: &str, nonce: &Nonce) -> (String, u64) {
    let digest = Digest::of(&[b"cosfly held-out suite\n", &nonce[..]].concat());
    let [first, second, third, ..] = digest.0;
    let bytes: [u8; 8] = std::array::from_fn(|at| digest.0[at + 8]);
    // Whole numbers of TOML have a sign.
    (format!("{recipe}_{first:02x}{second:02x}{third:02x}"), u64::from_le_bytes(bytes) >> 1)
}

/// The text of a recipe with another name and seed, and with the nonce.
pub fn text(recipe: &str, name: &str, seed: u64, nonce: &Nonce) -> String {
    let root = recipe.lines().position(|line| line.trim_start().starts_with('[')).unwrap_or(usize::MAX);
    let sets = |line: &str, key: &str| line.split_once('=').is_some_and(|(left, _)| left.trim() == key);
    let kept = recipe
        .lines()
        .enumerate()
        .filter(|(at, line)| *at >= root || !["name", "seed"].iter().any(|key| sets(line, key)));
    let kept: String = kept.map(|(_, line)| format!("{line}\n")).collect();
    let nonce: String = nonce.iter().map(|byte| format!("{byte:02x}")).collect();
    format!("name = \"{name}\"\nseed = {seed}\n{kept}\n[tool.{TABLE}]\nnonce = \"{nonce}\"\n")
}

/// The text with the hash of its suite: the secret.
pub fn with_suite(text: &str, suite: &Digest) -> String {
    format!("{text}suite = \"{suite}\"\n")
}

/// The digest to publish.
pub fn commitment(secret: &str) -> Digest {
    Digest::of(secret.as_bytes())
}

/// Whether a recipe has a nonce already.
pub fn is_held_out(recipe: &Recipe) -> bool {
    recipe.tool.contains_key(TABLE)
}

/// Holds a revealed recipe and its suite against what was published.
///
/// # Errors
/// `fly-commitment`, with what differs.
pub fn check(recipe: &Recipe, suite: &Suite, published: &str) -> Result<()> {
    let refused = |rule: String| {
        let message = format!("`{}` is not what was committed to: {rule}", recipe.path.display());
        Diagnostic::new("fly-commitment", Fault::Input, message)
            .hint("give the file that `cosfly fly commit` wrote, byte for byte, with the commitment that was published")
    };
    let found = commitment(&recipe.text).to_string();
    if found != published {
        return Err(refused(format!("its digest is {found}, the commitment is {published}")));
    }
    let kept = |key: &str| recipe.tool.get(TABLE).and_then(|table| table[key].as_str());
    let nonce = kept("nonce").and_then(nonce_of);
    let nonce = nonce.ok_or_else(|| refused(format!("it has no `nonce` in [tool.{TABLE}]")))?;
    // The seed cannot have been chosen: it follows from the nonce.
    let base = recipe.name.rsplit_once('_').map_or("", |(base, _)| base);
    if drawn(base, &nonce) != (recipe.name.clone(), recipe.seed) {
        return Err(refused("its name and seed do not follow from its nonce".to_owned()));
    }
    match kept("suite") {
        Some(hash) if hash == suite.digest.to_string() => Ok(()),
        hash => {
            let hash = hash.unwrap_or("no hash");
            Err(refused(format!("its episodes are others: its suite was {hash}, here it is {}", suite.digest)))
        }
    }
}

fn nonce_of(text: &str) -> Option<Nonce> {
    let digits = text.as_bytes();
    let byte = |at: usize| u8::from_str_radix(text.get(2 * at..2 * at + 2)?, 16).ok();
    let bytes: Vec<u8> = (0..32).map(byte).collect::<Option<_>>()?;
    bytes.try_into().ok().filter(|_| digits.len() == 64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_out_recipe_has_a_drawn_name_and_seed_and_the_rest_as_it_was() {
        let nonce = [7; 32];
        let (name, seed) = drawn("street", &nonce);
        assert_eq!((name.len(), drawn("street", &nonce)), ("street_".len() + 6, (name.clone(), seed)));
        assert_ne!(drawn("street", &[8; 32]).1, seed);
        let recipe = "# words\nname = \"street\"\nseed = 1\n\n[stages.town]\nseed = 4\n";
        let text = text(recipe, &name, seed, &nonce);
        let table =
            cosfly_recipe::table(std::path::Path::new("x.toml"), &with_suite(&text, &Digest::of(b""))).expect("TOML");
        assert_eq!((table["name"].as_str(), table["seed"].as_u64()), (Some(&*name), Some(seed)));
        assert_eq!(table["stages"]["town"]["seed"], 4);
        assert_eq!(table["tool"]["commitment"]["nonce"].as_str().and_then(nonce_of), Some(nonce));
        assert!(nonce_of("07").is_none() && nonce_of(&"ä".repeat(32)).is_none());
    }
}

//! Advice of refusals: each piece is carried out here as it stands, and helps.

mod datasets;
mod names;
mod recipes;
mod stages;

use crate::street::{RECIPE, Street, map};
use crate::support::cosfly;

/// A plan of the recipe: all of it is checked, nothing is made.
const PLAN: [&str; 2] = ["plan", "recipe.toml"];

/// Runs a call that is refused with some advice; gives its messages in one line, however their lines are broken.
fn refused(street: &Street, arguments: &[&str], advice: &str) -> String {
    let printed = cosfly(arguments).within(street.path()).run();
    let said = format!("{} {}", printed.stdout, printed.stderr);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(printed.code != Some(0) && said.contains(advice), "`{advice}` in {said}");
    said
}

fn helps(street: &Street, arguments: &[&str]) -> String {
    cosfly(arguments).within(street.path()).run_ok().stdout
}

/// The recipe of the street with one piece of text exchanged.
fn changed(from: &str, to: &str) -> Street {
    assert!(RECIPE.contains(from), "`{from}` is in the recipe");
    Street::with(&RECIPE.replacen(from, to, 1), &map())
}

/// Plans the recipe with a piece exchanged: refused with some advice; then with the piece as the advice has it.
fn followed(from: &str, wrong: &str, advice: &str, mended: &str) {
    refused(&changed(from, wrong), &PLAN, advice);
    helps(&changed(from, mended), &PLAN);
}

/// Plans the recipe with a piece exchanged: refused with a proposal, in backticks behind `words`; then with the proposal in
/// the place of `word`.
fn proposed(from: &str, wrong: &str, words: &str, word: &str) {
    let said = refused(&changed(from, wrong), &PLAN, words);
    let proposal = said.split(&format!("{words} `")).nth(1).and_then(|rest| rest.split('`').next());
    let proposal = proposal.unwrap_or_else(|| panic!("a proposal in {said}"));
    helps(&changed(from, &wrong.replacen(word, proposal, 1)), &PLAN);
}

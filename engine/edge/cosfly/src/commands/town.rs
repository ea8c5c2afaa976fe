//! `cosfly town`: a generated place as OpenDRIVE.

use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use clap::builder::{PossibleValue, PossibleValuesParser};
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_places::grid::{GenerateConfig, generate_town};
use cosfly_places::kinds::kind::PlaceKind;
use cosfly_places::kinds::{ALL, GRID};
use std::collections::BTreeMap;

/// Print a generated place as OpenDRIVE
#[derive(Debug, Parser)]
#[command(
    name = "town",
    after_help = "\
Examples:
  cosfly town --seed 7 > my_town.xodr
  cosfly town --place old_town --set size_m=250 --set lane_m=3 > old.xodr

The page \"Generated towns\" of the book lists the keys of each kind of place."
)]
pub struct Arguments {
    /// Kind of place
    #[arg(long, value_name = "NAME", default_value = GRID, value_parser = names())]
    place: String,
    /// Seed; every seed is another town
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Number of the kind of place, such as size_m=300 (repeatable)
    #[arg(long = "set", value_name = "KEY=NUMBER")]
    settings: Vec<String>,
}

fn names() -> PossibleValuesParser {
    let grid = PossibleValue::new(GRID).help("A downtown on a loose grid of streets");
    let others = ALL.iter().map(|kind| PossibleValue::new(kind.name).help(kind.doc));
    PossibleValuesParser::new([grid].into_iter().chain(others))
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let text = match ALL.iter().find(|kind| kind.name == self.place) {
            Some(kind) => self.of_kind(kind)?,
            None if self.settings.is_empty() => generate_town(&GenerateConfig::default(), self.seed),
            None => return Err(refused("the place `grid` has no keys for `--set`".into(), GRID_HINT.into()).into()),
        };
        console.print(&text)?;
        Ok(exit::SUCCESS)
    }
}

const GRID_HINT: &str = "write a JSON file with `town` for a grid of other sizes; see the page \"Generated towns\"";

impl Arguments {
    fn of_kind(&self, kind: &PlaceKind) -> Result<String, Box<Diagnostic>> {
        let mut given = BTreeMap::new();
        for setting in &self.settings {
            let number = setting.split_once('=').and_then(|(key, value)| Some((key, value.parse().ok()?)));
            let Some((key, number)) = number else {
                return Err(refused(format!("`--set {setting}` is not KEY=NUMBER"), "such as size_m=300".into()));
            };
            given.insert(key.to_owned(), number);
        }
        let settings = kind.settings(&given).map_err(|it| refused(it.message, it.hint))?;
        Ok(kind.open_drive(&settings, self.seed))
    }
}

fn refused(message: String, hint: String) -> Box<Diagnostic> {
    Diagnostic::new("town-settings", Fault::Recipe, message).hint(hint)
}

//! `cosfly init`: a folder with a recipe, its town and a page to begin with.

use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_cluster::shell_word;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_whole::{Appeared, NewFolder};
use std::path::{Path, PathBuf};

/// A recipe that can be begun with: its name, its use, its files with their texts.
struct Start {
    name: &'static str,
    doc: &'static str,
    files: &'static [(&'static str, &'static str)],
}

/// The starts; their recipes are those of the repository.
const STARTS: &[Start] = &[
    Start {
        name: "town",
        doc: "four pedestrians among three hundred others downtown, followed by experts and perturbed twins, at 1280 x 720",
        files: &[
            ("recipe.toml", include_str!("../../../../../recipes/carla_town.toml")),
            ("towns/downtown.xodr", include_str!("../../../../../recipes/towns/downtown.xodr")),
        ],
    },
    Start {
        name: "small",
        doc: "a small dataset in seconds",
        files: &[
            ("recipe.toml", include_str!("../../../../../recipes/small.toml")),
            ("towns/downtown.xodr", include_str!("../../../../../recipes/towns/downtown.xodr")),
        ],
    },
];

/// Write a folder to begin with: a recipe, its town, and a page that says how to go on
#[derive(Debug, Parser)]
#[command(
    name = "init",
    after_help = "\
Examples:
  cosfly init town && cosfly run town
  cosfly init my-flights --template small"
)]
pub struct Arguments {
    /// Folder to write; it must not exist
    #[arg(value_name = "NAME", default_value = "town")]
    folder: PathBuf,
    /// Recipe to begin with [default: the one called like the folder, else town]
    #[arg(long, value_name = "NAME", value_parser = starts())]
    template: Option<String>,
}

fn starts() -> clap::builder::PossibleValuesParser {
    clap::builder::PossibleValuesParser::new(
        STARTS.iter().map(|start| clap::builder::PossibleValue::new(start.name).help(start.doc)),
    )
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let folder_name = self.folder.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let wanted = self.template.as_deref().unwrap_or(folder_name);
        let start = STARTS.iter().find(|start| start.name == wanted).unwrap_or(&STARTS[0]);
        let shown = self.folder.display();
        // Not made for nothing; whether the place is free in the end, the folder's appearance says.
        if self.folder.exists() || write(&self.folder, start)? == Appeared::Taken {
            let message = format!("`{shown}` is there already");
            return Err(Diagnostic::new("init-exists", Fault::Recipe, message).hint("choose another name").into());
        }
        console.print(&format!("wrote `{shown}`: {}. Next:\n  cosfly run {}\n", start.doc, word(&self.folder)))?;
        Ok(exit::SUCCESS)
    }
}

/// The folder in a command.
fn word(folder: &Path) -> String {
    shell_word(&folder.to_string_lossy())
}

/// Writes the files beside the folder first, so that the folder is whole when it appears.
fn write(folder: &Path, start: &Start) -> Result<Appeared> {
    let refused = |error: std::io::Error| Diagnostic::io(format!("write `{}`", folder.display()), &error);
    let draft = NewFolder::beside(folder).map_err(refused)?;
    let page = format!(
        "# {2}\n\n`recipe.toml` describes {1}.\n\n\
         ```sh\ncosfly plan {0}                    # what would run, and why\ncosfly run {0}                     # make the dataset\n\
         cosfly verify out/...              # the folder that `cosfly run` names: check it\n\
         cosfly run {0} --set stages.walkers.count=20   # another dataset; finished items are kept\n```\n\n\
         Change `recipe.toml` with any editor: its first line names the schema for completion (`cosfly schema`).\n",
        word(folder),
        start.doc,
        folder.display()
    );
    let schema = cosfly_recipe::schema(&cosfly_stages::registry());
    let schema = serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n";
    let more = [("README.md", page.as_str()), ("recipe.schema.json", &schema)];
    for (name, text) in start.files.iter().copied().chain(more) {
        // The recipe names its schema and itself by their places in the repository.
        let text = text.replace("../schemas/recipe.schema.json", "recipe.schema.json");
        let text = text.replace("recipes/carla_town.toml", &folder.display().to_string());
        let path = draft.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap_or(Path::new("."))).map_err(refused)?;
        std::fs::write(path, text).map_err(refused)?;
    }
    draft.appear().map_err(refused)
}

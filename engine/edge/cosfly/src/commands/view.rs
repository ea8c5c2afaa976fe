//! `cosfly view`: a page of a dataset, of results or of a recipe in the browser.

mod browser;
mod recipe;
mod results;

use crate::arguments::{RecipeArguments, StoreArguments, file_ending_in};
use crate::command::{Command, Outcome, Refusals};
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count};
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_view::{DatasetSubject, NothingSubject, Server, ViewSubject, export};
use cosfly_whole::write_file;
use recipe::RecipeSubject;
use results::ResultsSubject;
use std::path::{Path, PathBuf};

/// Look at flights in the browser: worst first, with map, pictures, texts and numbers
#[derive(Debug, Parser)]
#[command(
    name = "view",
    after_help = "\
Examples:
  cosfly view out/carla_town                    a dataset: flights, worst first, experts beside twins
  cosfly view out/fly/street                    results of `cosfly fly`, policy beside policy
  cosfly view recipes/carla_town.toml           progress of a recipe while `cosfly run` makes it
  cosfly view out/carla_town --no-open --port 8000
  cosfly view out/carla_town --export page.html

The page is served to this machine alone, and opens once with the printed address. Ctrl-C ends the server, with exit code 0.
Nothing is read outside the dataset; links that lead out of it are refused. An exported page has the worst flights that fit
into 50 MB, with up to 60 colour pictures of each."
)]
pub struct Arguments {
    /// Folder of a dataset, of results of `cosfly fly`, or a recipe
    #[arg(value_name = "DATASET|RESULT|RECIPE")]
    subject: PathBuf,
    /// Port of 127.0.0.1 [default: a free one]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Print the address without opening a browser
    #[arg(long)]
    no_open: bool,
    /// Write the page with its data into one file instead
    #[arg(long, value_name = "FILE", value_parser = file_ending_in(&["html", "htm"]), conflicts_with_all = ["port", "no_open"])]
    export: Option<PathBuf>,
    #[command(flatten)]
    store: StoreArguments,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let subject = self.open(console)?;
        if let Some(path) = &self.export {
            return self.write(&*subject, path, console);
        }
        let cancelled = console.cancelled();
        let server = Server::bind(self.port)?;
        console.print(&format!("{}\n", server.address()))?;
        if !self.no_open && !browser::open(&server.address()) {
            console.tell("note: no browser could be started; open the address above");
        }
        console.tell("Ctrl-C ends the server");
        server.serve(&*subject, &cancelled);
        Ok(exit::SUCCESS)
    }
}

impl Arguments {
    /// Subject of the page.
    fn open(&self, console: &dyn Console) -> Result<Box<dyn ViewSubject>, Refusals> {
        let path = &self.subject;
        if results::is_of_results(path) {
            return Ok(Box::new(ResultsSubject::open(path)?));
        }
        let is_recipe = path.extension().is_some_and(|it| it == "toml") || path.join("recipe.toml").is_file();
        if is_recipe && !path.join("data").is_dir() {
            let recipe = RecipeArguments { recipe: path.clone(), overrides: vec![] }.load(console)?;
            return Ok(Box::new(RecipeSubject::open(recipe, self.store.clone(), &console.stop())?));
        }
        match DatasetSubject::open(path, &console.stop()) {
            Err(refusal) if refusal.code == "dataset-none" && path.is_dir() && self.export.is_none() => {
                Ok(Box::new(NothingSubject::new(path.display().to_string(), &refusal)))
            }
            opened => Ok(Box::new(opened?)),
        }
    }

    /// Writes the page into a file.
    fn write(&self, subject: &dyn ViewSubject, path: &Path, console: &dyn Console) -> Outcome {
        let index = subject.index()?;
        if index.is_empty() {
            let message = format!("`{}` has no flights to export", self.subject.display());
            return Err(Diagnostic::new("view-empty", Fault::Recipe, message).into());
        }
        let (page, held) = export(subject, index.worst(), &console.stop())?;
        write_file(path, page.as_bytes())
            .map_err(|error| Diagnostic::io(format!("write `{}`", path.display()), &error))?;
        let (shown, size) = (path.display(), bytes(page.len() as u64));
        let all = count(index.len() as u64, "flight");
        console.print(&format!("{shown}: {size}, the worst {held} of {all} with their pictures\n"))?;
        Ok(exit::SUCCESS)
    }
}

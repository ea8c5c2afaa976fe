//! `cosfly fly bundle`: a result of `cosfly fly` as one file.

use crate::command::Outcome;
use crate::console::Console;
use crate::exit;
use crate::text;
use clap::Args;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fly::bundle::Bundle;
use cosfly_fly::pilot::OnnxPolicy;
use cosfly_whole::write_file;
use std::ffi::OsStr;
use std::path::PathBuf;

/// Make a result one file that anyone can fly again: card, rows, actions of every step
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  cosfly fly bundle out/fly/street/mine
  cosfly fly bundle out/fly/street/mine --with-policy mine.onnx

The file is JSON lines in zstd (`zstdcat` shows them): the card, a line for each episode, a digest. Texts of the task and of failures are
left out. `--with-policy` puts a network in ONNX into it, so that others can run it again. `cosfly fly verify FILE SUITE` flies the actions again.")]
pub struct Arguments {
    /// Folder of a finished result
    #[arg(value_name = "RESULT")]
    result: PathBuf,
    /// The file [default: RESULT.jsonl.zst]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// The file of the policy, a network in ONNX, to hold in the bundle; as it is, with all texts in it
    #[arg(long, value_name = "FILE")]
    with_policy: Option<PathBuf>,
}

impl Arguments {
    /// Does the work.
    pub fn run(&self, console: &dyn Console) -> Outcome {
        let mut bundle = Bundle::of(&self.result)?;
        if let Some(file) = &self.with_policy {
            bundle = bundle.with_policy(&OnnxPolicy::read(file)?)?;
        }
        let bytes = bundle.bytes()?;
        let path = self.out.clone().unwrap_or_else(|| {
            let mut name = self.result.file_name().unwrap_or(OsStr::new("result")).to_owned();
            name.push(".jsonl.zst");
            self.result.with_file_name(name)
        });
        let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        let written: Result<()> = (folder.and_then(|()| write_file(&path, &bytes)))
            .map_err(|error| Diagnostic::io(format!("write {}", path.display()), &error));
        written?;
        let (shown, episodes) = (path.display(), text::count(bundle.episodes.len() as u64, "episode"));
        console.print(&format!("{shown}: {episodes}, {}\n", text::bytes(bytes.len() as u64)))?;
        Ok(exit::SUCCESS)
    }
}

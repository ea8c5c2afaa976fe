//! A format by its name, with options: those of other formats are refused.

use crate::format::{Export, Prepared};
use crate::formats::FORMATS;
use crate::option::{ExportOption, foreign};
use cosfly_diagnose::{Diagnostic, Fault, Result, counted, nearest_name};
use serde_json::{Map, Value};

/// The format `name` with `options`; those that are absent have their defaults.
///
/// # Errors
/// `export-format` for a name that no format has, `export-option` for an option that the format does not have or a value
/// that it does not take.
pub fn prepare(name: &str, options: Map<String, Value>) -> Result<Prepared> {
    let format = format(name)?;
    if let Some(option) = foreign(&options, &format.options()).next() {
        return Err(refusal(format, option));
    }
    format.with(options)
}

fn format(name: &str) -> Result<&'static Export> {
    FORMATS.iter().find(|format| format.name == name).ok_or_else(|| {
        let refusal = Diagnostic::new("export-format", Fault::Recipe, format!("there is no format `{name}`"));
        let names = || FORMATS.iter().map(|format| format.name);
        match nearest_name(name, names()) {
            Some(near) => refusal.hint(format!("did you mean `{near}`?")),
            None => refusal.hint(format!("the formats are {}", quoted(names()))),
        }
    })
}

fn refusal(format: &Export, option: &str) -> Box<Diagnostic> {
    let owners = joined_options().into_iter().find(|(known, _)| known.name == option);
    let shown = flag(option);
    let message = format!("format `{}` has no option `{shown}`", format.name);
    let refusal = Diagnostic::new("export-option", Fault::Recipe, message);
    let refusal = match owners {
        Some((_, owners)) => refusal.hint(format!("`{shown}` is an option of {}", quoted(owners))),
        None => refusal,
    };
    let own: Vec<String> = format.options().iter().map(|option| flag(&option.name)).collect();
    refusal.hint(match own.is_empty() {
        true => format!("`{}` has no options of its own", format.name),
        false => format!("options of `{}` are {}", format.name, quoted(own)),
    })
}

/// All options, each once, with the names of the formats that have it; options of the same formats are together.
pub fn joined_options() -> Vec<(ExportOption, Vec<&'static str>)> {
    let mut joined: Vec<(ExportOption, Vec<&'static str>)> = vec![];
    for format in FORMATS {
        for option in format.options() {
            match joined.iter_mut().find(|(known, _)| known.name == option.name) {
                Some((_, formats)) => formats.push(format.name),
                None => joined.push((option, vec![format.name])),
            }
        }
    }
    joined.sort_by(|a, b| b.1.len().cmp(&a.1.len()).then_with(|| a.1.cmp(&b.1)));
    joined
}

/// Does `work` on threads of its own, `count` of them; without a number, on those of the process, one per core.
///
/// # Errors
/// `machine-threads`.
pub fn on_threads<R: Send>(count: Option<u16>, work: impl FnOnce() -> R + Send) -> Result<R> {
    let Some(count) = count else { return Ok(work()) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(count)).build();
    let pool = pool.map_err(|error| {
        Diagnostic::new(
            "machine-threads",
            Fault::Machine,
            format!("could not start {count}", count = counted(count, "thread")),
        )
        .because(error)
    })?;
    Ok(pool.install(work))
}

/// The option `name` on a command line.
pub fn flag(name: &str) -> String {
    format!("--{}", name.replace('_', "-"))
}

fn quoted(names: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let names: Vec<String> = names.into_iter().map(|name| format!("`{}`", name.as_ref())).collect();
    names.join(", ")
}

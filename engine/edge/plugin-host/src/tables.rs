//! A plugin as a stage: what it declares, held against the rules, then one flight in as an Arrow stream and an answer out.

use crate::failure::PluginError;
use crate::interface_0_1::{Column, Declaration, Effect, Refusal, ValueKind};
use crate::plugin::Plugin;
use crate::session::Session;
use crate::town::TownView;
use cosfly_diagnose::counted;
use std::collections::BTreeSet;
use std::sync::Arc;
use wasmtime::component::TypedFunc;

type Configure = TypedFunc<(String,), (Result<Declaration, Refusal>,)>;
type Run = TypedFunc<(Vec<u8>,), (Result<Vec<u8>, Refusal>,)>;

/// Most columns that a stage reads, and that it gives.
const MOST_READ: usize = 256;
const MOST_GIVEN: usize = 64;
/// Longest description of a column.
const MOST_DOC: usize = 300;

/// Result for a flight.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answered {
    /// An Arrow stream, not looked at yet.
    pub answer: Vec<u8>,
    /// Messages of the plugin to users.
    pub warnings: Vec<String>,
}

/// Columns that `plugin` reads and gives with these parameters, JSON text.
///
/// # Errors
/// Refusal of the plugin, or the rule that its declaration breaks.
pub fn declaration(plugin: &Plugin, town: Arc<dyn TownView>, params: &str) -> Result<Declaration, PluginError> {
    configured(&mut Session::open(plugin, town)?, plugin, params)
}

/// Gives a flight to `plugin`, with parameters as JSON text. `encode` makes the flight's stream with the columns that are
/// declared, or says why it cannot.
///
/// # Errors
/// Refusal or fault of the plugin.
pub fn run_stage(
    plugin: &Plugin,
    town: Arc<dyn TownView>,
    params: &str,
    encode: impl FnOnce(&Declaration) -> Result<Vec<u8>, PluginError>,
) -> Result<(Declaration, Answered), PluginError> {
    let mut session = Session::open(plugin, town)?;
    let declared = configured(&mut session, plugin, params)?;
    let run: Run = session.function("run")?;
    let (answer,) = session.call("run", &run, (encode(&declared)?,))?;
    let answer = answer.map_err(|refusal| PluginError::failed(&plugin.shown, "run", refusal.words()))?;
    Ok((declared, Answered { answer, warnings: session.warnings() }))
}

fn configured(session: &mut Session, plugin: &Plugin, params: &str) -> Result<Declaration, PluginError> {
    let configure: Configure = session.function("configure")?;
    let (declared,) = session.call("configure", &configure, (params.to_owned(),))?;
    let failed = |words: String| PluginError::failed(&plugin.shown, "configure", words);
    let declared = declared.map_err(|refusal| failed(refusal.words()))?;
    check(&declared).map_err(failed)?;
    Ok(declared)
}

/// The rules of declarations.
fn check(declared: &Declaration) -> Result<(), String> {
    check_columns("reads", &declared.reads, MOST_READ)?;
    check_columns("gives", &declared.gives, MOST_GIVEN)?;
    if let Some(column) = declared.reads.iter().find(|column| column.kind == ValueKind::Bytes) {
        return Err(format!("it reads `{}` as bytes; there are no such columns", column.name));
    }
    let (effect, gives) = (declared.effect.words(), &declared.gives);
    let has_name = matches!(declared.effect, Effect::Annotate | Effect::Rows | Effect::Files);
    if has_name && !is_plain(&declared.name) {
        return Err(format!(
            "it names `{}` what it makes of flights; it must be 1 to 60 of `a-z`, `0-9` and `_`",
            shortened(&declared.name)
        ));
    }
    if !has_name && !declared.name.is_empty() {
        return Err(format!("it names `{}`, but {effect} makes no table", shortened(&declared.name)));
    }
    let wanted: Option<[(&str, ValueKind); 2]> = match declared.effect {
        Effect::Filter => Some([("keep", ValueKind::Boolean), ("reason", ValueKind::Text)]),
        Effect::Files => Some([("path", ValueKind::Text), ("content", ValueKind::Bytes)]),
        Effect::Label | Effect::Annotate | Effect::Rows => None,
    };
    if let Some(wanted) = wanted {
        let found: Vec<(&str, ValueKind)> = gives.iter().map(|it| (it.name.as_str(), it.kind)).collect();
        let words = |all: &[(&str, ValueKind)]| {
            let each = all.iter().map(|(name, kind)| format!("`{name}` ({})", kind.words()));
            if all.is_empty() { "nothing".to_owned() } else { each.collect::<Vec<_>>().join(", ") }
        };
        return if found == wanted {
            Ok(())
        } else {
            Err(format!("it gives {}; {effect} gives {}", words(&found), words(&wanted)))
        };
    }
    if gives.is_empty() {
        return Err(format!("it gives nothing; {effect} gives 1 to {MOST_GIVEN} columns"));
    }
    let is_wrong = |column: &&Column| match declared.effect {
        Effect::Label => column.kind != ValueKind::Real,
        _ => column.kind == ValueKind::Bytes,
    };
    match gives.iter().find(is_wrong) {
        Some(column) if declared.effect == Effect::Label => {
            Err(format!("its label `{}` is declared as {}; labels are real", column.name, column.kind.words()))
        }
        Some(column) => Err(format!("it gives `{}` as bytes; only `content` of files may be that", column.name)),
        None => Ok(()),
    }
}

fn check_columns(what: &str, columns: &[Column], most: usize) -> Result<(), String> {
    if columns.len() > most {
        return Err(format!("it {what} {}; at most {most} are possible", counted(columns.len(), "column")));
    }
    let mut seen = BTreeSet::new();
    for Column { name, doc, .. } in columns {
        if !is_plain(name) {
            return Err(format!("it {what} a column `{}`; names are 1 to 60 of `a-z`, `0-9` and `_`", shortened(name)));
        }
        if !seen.insert(name) {
            return Err(format!("it {what} `{name}` twice"));
        }
        if doc.chars().count() > MOST_DOC || doc.chars().any(char::is_control) {
            return Err(format!("it describes `{name}` in more than {MOST_DOC} letters or more than one line"));
        }
    }
    Ok(())
}

fn shortened(name: &str) -> String {
    name.chars().take(80).collect()
}

fn is_plain(name: &str) -> bool {
    let is_plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
    (1..=60).contains(&name.len()) && name.bytes().all(is_plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(name: &str, kind: ValueKind) -> Column {
        Column { name: name.to_owned(), kind, doc: String::new() }
    }

    fn refusal(effect: Effect, name: &str, gives: Vec<Column>) -> String {
        check(&Declaration { effect, name: name.to_owned(), reads: vec![], gives }).err().unwrap_or_default()
    }

    #[test]
    fn declarations_that_break_a_rule_are_refused_with_the_rule() {
        let real = |name: &str| column(name, ValueKind::Real);
        assert_eq!(refusal(Effect::Label, "", vec![real("risk")]), "");
        for (effect, name, gives, words) in [
            (
                Effect::Filter,
                "",
                vec![column("keep", ValueKind::Text)],
                "it gives `keep` (text); a filter gives `keep`",
            ),
            (Effect::Filter, "", vec![], "it gives nothing; a filter gives"),
            (Effect::Files, "tum", vec![column("path", ValueKind::Text)], "gives `path` (text), `content` (bytes)"),
            (Effect::Files, "../x", vec![], "it names `../x`"),
            (Effect::Rows, "", vec![real("a")], "it names ``"),
            (Effect::Label, "a", vec![real("a")], "makes no table"),
            (Effect::Rows, "a", vec![], "it gives nothing"),
            (Effect::Rows, "a", vec![column("a", ValueKind::Bytes)], "as bytes"),
            (Effect::Label, "", vec![column("a", ValueKind::Integer)], "labels are real"),
            (Effect::Rows, "a", vec![real("b"), real("b")], "`b` twice"),
            (Effect::Rows, "a", vec![real("B")], "names are 1 to 60"),
            (Effect::Rows, "a", (0..65).map(|k| real(&format!("c{k}"))).collect(), "65 columns; at most 64"),
        ] {
            let found = refusal(effect, name, gives);
            assert!(found.contains(words), "{found}");
        }
    }
}

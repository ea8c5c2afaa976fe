//! Declarations of plugins that are stages, checked against the columns that exist and the output of their stage.

use super::config::Makes;
use super::{Column, Declaration, Effect, ValueKind};
use cosfly_schema::extras::{self, ExtraShape, ExtraSource};
use cosfly_schema::flight_table::{ColumnKind, DeclaredColumn, check_names};

/// Message and hint of a refusal.
pub type PluginRefusal = (String, Option<String>);

/// Columns of a declaration in the form of datasets.
pub fn columns(declared: &[Column]) -> Vec<DeclaredColumn> {
    let kind = |kind: ValueKind| match kind {
        ValueKind::Real => ColumnKind::Real,
        ValueKind::Integer => ColumnKind::Integer,
        ValueKind::Boolean => ColumnKind::Boolean,
        ValueKind::Text => ColumnKind::Text,
        ValueKind::Bytes => ColumnKind::Bytes,
    };
    let of = |column: &Column| DeclaredColumn {
        name: column.name.clone(),
        kind: kind(column.kind),
        doc: column.doc.clone(),
    };
    declared.iter().map(of).collect()
}

/// Checks that a stage that makes `makes` can do what the plugin declares.
///
/// # Errors
/// Parts of the declaration that do not fit.
pub fn check(declared: &Declaration, makes: Makes) -> Result<(), PluginRefusal> {
    let of_flights = matches!(declared.effect, Effect::Filter | Effect::Label);
    match makes {
        Makes::Flights if !of_flights => {
            let message = format!("it is {}, and makes no flights", declared.effect.words());
            let hint = "write `makes = \"extras\"` and `inputs.frames`, and connect the stage to the dataset's `inputs.extras`";
            return Err((message, Some(hint.to_owned())));
        }
        Makes::Extras if of_flights => {
            let hint = "leave `makes` away and connect `inputs.trajectories`";
            return Err((format!("it is {}, and makes no extras", declared.effect.words()), Some(hint.to_owned())));
        }
        Makes::Flights | Makes::Extras => {}
    }
    check_names(&columns(&declared.reads), makes == Makes::Extras).map_err(|it| (it.message, it.hint))?;
    if matches!(declared.effect, Effect::Annotate | Effect::Rows) {
        extras::check_names(&declared.name, &columns(&declared.gives)).map_err(|message| (message, None))?;
    }
    Ok(())
}

/// Source of extras: `plugin` is its name, version and summary. `None` for other effects.
pub fn source_of(declared: &Declaration, [plugin, version, summary]: [&str; 3]) -> Option<ExtraSource> {
    let shape = match declared.effect {
        Effect::Filter | Effect::Label => return None,
        Effect::Annotate => ExtraShape::Annotation,
        Effect::Rows => ExtraShape::Rows,
        Effect::Files => ExtraShape::Files,
    };
    Some(ExtraSource {
        name: declared.name.clone(),
        shape,
        columns: columns(&declared.gives),
        plugin: plugin.to_owned(),
        version: version.to_owned(),
        summary: summary.to_owned(),
    })
}

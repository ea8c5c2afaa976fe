//! The options of all formats on the command line, made from the formats' own schemas.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches};
use cosfly_export::{ExportOption, OptionKind, flag, joined_options};
use serde_json::{Map, Value};

/// The options that were given, by the names of their schemas.
#[derive(Clone, Debug, Default)]
pub struct FormatOptions(pub Map<String, Value>);

impl Args for FormatOptions {
    fn augment_args(command: Command) -> Command {
        joined_options().into_iter().fold(command, |command, (option, formats)| {
            command.arg(argument(&option).help_heading(format!("Options of {}", formats.join(", "))))
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for FormatOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let options = joined_options().into_iter().map(|(option, _)| option);
        let given = options.filter(|option| matches.value_source(&option.name) == Some(ValueSource::CommandLine));
        Ok(Self(given.map(|option| (option.name.clone(), value(&option, matches))).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        self.0.extend(Self::from_arg_matches(matches)?.0);
        Ok(())
    }
}

fn argument(option: &ExportOption) -> Arg {
    let argument = Arg::new(option.name.clone()).long(flag(&option.name).trim_start_matches('-').to_owned());
    let placeholder = |usual: &str| option.placeholder.clone().unwrap_or_else(|| usual.to_owned());
    let argument = match &option.kind {
        OptionKind::Flag => argument.action(ArgAction::SetTrue),
        OptionKind::Count { least, most } => {
            argument.value_name(placeholder("N")).value_parser(clap::value_parser!(u64).range(*least..=*most))
        }
        OptionKind::Number => argument.value_name(placeholder("NUMBER")).value_parser(clap::value_parser!(f64)),
        OptionKind::Choice(words) => {
            let words = words.iter().map(|(word, doc)| PossibleValue::new(word.clone()).help(doc.clone()));
            let usual = option.name.to_uppercase();
            argument.value_name(placeholder(&usual)).value_parser(PossibleValuesParser::new(words).map(Value::String))
        }
        OptionKind::Text => argument.value_name(placeholder("TEXT")),
        OptionKind::Texts => argument.value_name(placeholder("TEXT")).action(ArgAction::Append),
    };
    let repeatable = if option.kind == OptionKind::Texts { " (repeatable)" } else { "" };
    let argument = argument.help(format!("{}{repeatable}", option.doc));
    match &option.default {
        Value::String(word) => argument.default_value(word.clone()),
        Value::Number(number) => argument.default_value(number.to_string()),
        _ => argument,
    }
}

/// The value that was given, as in the option's schema.
fn value(option: &ExportOption, matches: &ArgMatches) -> Value {
    let name = &option.name;
    match option.kind {
        OptionKind::Flag => Value::Bool(true),
        OptionKind::Count { .. } => matches.get_one::<u64>(name).copied().into(),
        OptionKind::Number => matches.get_one::<f64>(name).copied().into(),
        OptionKind::Choice(_) => matches.get_one::<Value>(name).cloned().into(),
        OptionKind::Text => matches.get_one::<String>(name).cloned().into(),
        OptionKind::Texts => matches.get_many::<String>(name).into_iter().flatten().cloned().collect(),
    }
}

//! Collects what plugins and sensors gave of all flights: the same from each, under names of its own.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::extras::{Extra, ExtraSource, ExtraSummary};

/// Sources of the plugins' tables and files for `flights` flights: each once, in the order of names. `of_flight` reads
/// those of one flight.
///
/// # Errors
/// Two plugins of one name; a plugin that gave not of every flight, or something else of some.
pub fn gather(flights: usize, of_flight: &dyn Fn(usize) -> Result<Vec<Extra>>) -> Result<Vec<ExtraSource>> {
    let mut all: Vec<(ExtraSource, usize)> = vec![];
    for flight in 0..flights {
        for extra in of_flight(flight)? {
            match all.iter_mut().find(|(known, _)| known.name == extra.source.name) {
                Some((known, times)) if *known == extra.source && *times == flight => *times += 1,
                Some((known, times)) => return Err(conflict(known, &extra.source, *times > flight)),
                None if flight == 0 => all.push((extra.source, 1)),
                None => return Err(not_of_all(&extra.source)),
            }
        }
    }
    if let Some((source, _)) = all.iter().find(|(_, times)| *times != flights) {
        return Err(not_of_all(source));
    }
    all.sort_by(|a, b| a.0.name.cmp(&b.0.name));
    Ok(all.into_iter().map(|(source, _)| source).collect())
}

/// Summaries over the flights of both: each plugin gave of all of them, and the same.
///
/// # Errors
/// Those of [`gather`].
pub fn merged(first: Vec<ExtraSummary>, second: Vec<ExtraSummary>) -> Result<Vec<ExtraSummary>> {
    let other = |all: &[ExtraSummary], name: &str| all.iter().position(|it| it.source.name == name);
    if let Some(alone) = second.iter().find(|it| other(&first, &it.source.name).is_none()) {
        return Err(not_of_all(&alone.source));
    }
    let add = |mut it: ExtraSummary| {
        let more = other(&second, &it.source.name).map(|at| &second[at]).ok_or_else(|| not_of_all(&it.source))?;
        if more.source != it.source {
            return Err(conflict(&it.source, &more.source, false));
        }
        more.rows.iter().for_each(|(split, rows)| *it.rows.entry(split.clone()).or_default() += rows);
        it.files += more.files;
        it.depths.extend(&more.depths);
        Ok(it)
    };
    first.into_iter().map(add).collect()
}

fn conflict(known: &ExtraSource, other: &ExtraSource, is_twice: bool) -> Box<Diagnostic> {
    let name = &known.name;
    let (what, hint) = if is_twice || known.plugin != other.plugin {
        ("two stages give", "let one of them give it another name (a sensor: `table`), or connect one of them only")
    } else {
        ("its flights differ in", "each flight needs the same declaration")
    };
    let message = format!("{what} `{name}`: {} and {}", known.origin(), other.origin());
    Diagnostic::new("dataset-extras", Fault::Recipe, message).hint(hint)
}

fn not_of_all(source: &ExtraSource) -> Box<Diagnostic> {
    let message = format!("{} gave `{}` of some flights only", source.origin(), source.name);
    Diagnostic::new("dataset-extras", Fault::Recipe, message)
        .hint("let its stage read the frames that the dataset has, `inputs.frames`")
}

/// Where a file of a flight lies; `log` is the path of the flight's log.
pub fn path_of_file(name: &str, log: &str, path: &str) -> String {
    let flight = log.strip_prefix("mcap/").unwrap_or(log);
    format!("extras/{name}/{}/{path}", flight.strip_suffix(".mcap").unwrap_or(flight))
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_schema::extras::ExtraShape;

    fn extra(name: &str, plugin: &str) -> Extra {
        let (name, plugin) = (name.to_owned(), plugin.to_owned());
        let (version, summary) = ("1".to_owned(), String::new());
        let source = ExtraSource { name, shape: ExtraShape::Files, columns: vec![], plugin, version, summary };
        Extra { source, values: vec![] }
    }

    #[test]
    fn every_plugin_gives_of_every_flight_and_under_its_own_name() {
        let (a, b) = (extra("a", "p"), extra("b", "q"));
        let names = |flights: Vec<Vec<Extra>>| {
            let sources = gather(flights.len(), &|flight| Ok(flights[flight].clone()));
            sources.map(|all| all.into_iter().map(|it| it.name).collect::<Vec<_>>()).map_err(|it| it.message)
        };
        let both = || vec![b.clone(), a.clone()];
        assert_eq!(names(vec![both(), both()]), Ok(vec!["a".to_owned(), "b".to_owned()]));
        assert!(names(vec![both(), vec![a.clone()]]).unwrap_err().contains("`b` of some flights only"));
        assert!(names(vec![vec![a.clone()], both()]).unwrap_err().contains("`b` of some flights only"));
        assert!(names(vec![vec![a.clone(), extra("a", "z")]]).unwrap_err().contains("two stages give `a`"));
        assert!(names(vec![vec![a.clone(), a.clone()]]).unwrap_err().contains("two stages give `a`"));
        assert!(names(vec![]).unwrap().is_empty());
    }

    #[test]
    fn files_lie_like_the_logs() {
        let path = path_of_file("tum", "mcap/town/000/expert-p00000.mcap", "camera.txt");
        assert_eq!(path, "extras/tum/town/000/expert-p00000/camera.txt");
    }
}

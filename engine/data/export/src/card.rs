//! The `README.md` of an export, and the licence that goes with it.

use crate::folder::OutFolder;
use crate::source::Source;
use cosfly_diagnose::{Diagnostic, Result, counted};
use cosfly_domain::{Lens, LensModel};
use cosfly_plot::text::{markdown, markdown_code};
use cosfly_read::foreign_rows;
use cosfly_schema::tables::Trajectories;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::PathBuf;

/// Content of the card of an export.
#[derive(Clone, Debug, Default)]
pub struct ExportCard {
    /// Name of the format.
    pub format: &'static str,
    /// More lines of the front matter, such as `configs`.
    pub front_matter: String,
    /// Loading, layout, meaning of every number. Markdown.
    pub body: String,
}

impl ExportCard {
    /// Writes `README.md`, and `LICENSE` as the dataset has it.
    pub fn write(&self, source: &Source<'_>, out: &OutFolder) -> Result<()> {
        let folder = source.dataset.folder();
        let original = std::fs::read_to_string(folder.join("README.md")).unwrap_or_default();
        let name = source.name();
        let mut text = String::from("---\n");
        for line in kept_lines(&original) {
            let _ = writeln!(text, "{line}");
        }
        let _ = write!(text, "{}---\n\n# {} in the format {}\n\n", self.front_matter, markdown(&name), self.format);
        let flights: Vec<_> = source.flights().collect();
        let frames: usize = flights.iter().map(|flight| flight.frames).sum();
        let _ = writeln!(
            text,
            "Written by `cosfly export` {} from {} with {} of the dataset {}.\n",
            env!("CARGO_PKG_VERSION"),
            counted(flights.len(), "flight"),
            counted(frames, "frame"),
            markdown_code(&name)
        );
        text.push_str(&self.body);
        text.push_str(&optics(source)?);
        out.put("README.md", text.as_bytes())?;
        match std::fs::read(folder.join("LICENSE")) {
            Ok(license) => out.put("LICENSE", &license),
            Err(_) => Ok(()),
        }
    }
}

/// Weather, lens, shutter and noise of the chosen flights, for which the formats have no place.
fn optics(source: &Source<'_>) -> Result<String> {
    let ids: BTreeSet<&str> = source.flights().map(|flight| &*flight.trajectory_id).collect();
    let mut columns: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    let folder = source.dataset.folder().join("data/trajectories");
    let entries = std::fs::read_dir(&folder).and_then(|entries| entries.map(|it| Ok(it?.path())).collect());
    let mut paths: Vec<PathBuf> =
        entries.map_err(|error| Diagnostic::io(format!("read `{}`", folder.display()), &error))?;
    paths.sort();
    for path in paths {
        let rows = foreign_rows(&path, false)?;
        let names = rows.texts.get("trajectory_id").map_or(&[][..], Vec::as_slice);
        for name in Trajectories::OPTICS.iter().map(|column| column.name()) {
            let values = rows.numbers.get(name).into_iter().flatten().zip(names);
            let values = values.filter(|(_, id)| ids.contains(id.as_str())).filter_map(|(value, _)| value.first());
            columns.entry(name).or_default().extend(values.copied());
        }
    }
    let mut weathers: BTreeMap<&str, usize> = BTreeMap::new();
    let mut sizes: BTreeSet<String> = BTreeSet::new();
    for flight in source.flights() {
        *weathers.entry(&flight.weather).or_default() += 1;
        let fov_deg = flight.lens.span_rad(&flight.camera).to_degrees();
        sizes.insert(format!("{} x {} pixels, {fov_deg:.1}° wide", flight.camera.width, flight.camera.height));
    }
    let weathers: Vec<String> =
        weathers.iter().map(|(name, count)| format!("{} ({count})", markdown_code(name))).collect();
    let mut text = format!("\n## Camera and weather\n\n* Weather, with flights: {}.\n", weathers.join(", "));
    let _ = writeln!(text, "* Picture: {}.", sizes.into_iter().collect::<Vec<_>>().join("; "));
    let bends: BTreeSet<String> = source
        .flights()
        .filter(|it| !it.lens.is_none())
        .map(|it| {
            let Lens { model, k1, k2, .. } = it.lens;
            match model {
                LensModel::Brown => format!("Brown's radial terms {:?} (k1, k2)", [k1, k2]),
                LensModel::Fisheye => format!("OpenCV's `fisheye` {:?} (k1 to k4)", it.lens.coefficients()),
                LensModel::Equirectangular => "all around, equirectangular".to_owned(),
            }
        })
        .collect();
    let _ = match bends.is_empty() {
        true => writeln!(text, "* Lens: a pinhole; nothing is bent."),
        false => writeln!(
            text,
            "* Lens: {}. Focal lengths are those in the middle of the picture.",
            bends.into_iter().collect::<Vec<_>>().join("; ")
        ),
    };
    if source.flights().any(|it| it.lens.is_wide(&it.camera)) {
        text.push_str(
            "* Depth of pictures all around, and of fisheyes that see beyond 80° from their axis, is the distance along the ray of a \
             pixel, not along the optical axis.\n",
        );
    }
    for column in Trajectories::OPTICS {
        let values = columns.get(column.name()).map_or(&[][..], Vec::as_slice);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let range = match values {
            [] => "unknown".to_owned(),
            _ if least == most => most.to_string(),
            _ => format!("{least} to {most}"),
        };
        let _ = writeln!(text, "* `{}`: {range}. {}", column.name(), column.doc());
    }
    Ok(text)
}

/// Licence and language of a card's front matter.
fn kept_lines(card: &str) -> impl Iterator<Item = &str> {
    let front = card.strip_prefix("---\n").and_then(|rest| rest.split_once("\n---")).map_or("", |(front, _)| front);
    let mut is_kept = false;
    front.lines().filter(move |line| {
        if !line.starts_with(['-', ' ']) {
            is_kept = ["license", "language:", "pretty_name:"].iter().any(|key| line.starts_with(key));
        }
        is_kept
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn licence_and_language_stay_and_configs_go() {
        let card = "---\nlicense: other\nlicense_link: LICENSE\nlanguage:\n- en\n- zh\nconfigs:\n- config_name: a\n---\n# x\n- y";
        assert_eq!(
            kept_lines(card).collect::<Vec<_>>(),
            ["license: other", "license_link: LICENSE", "language:", "- en", "- zh"]
        );
        assert_eq!(kept_lines("# no front matter").count(), 0);
    }
}

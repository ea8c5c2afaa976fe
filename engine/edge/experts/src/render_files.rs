//! Models, mesh and splats of a `render` stage: files of the recipe, checked before any stage runs.

use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_domain::{Town, Trajectory};
use cosfly_frames::DVec3;
use cosfly_materials::dry_days;
use cosfly_models::Model;
use cosfly_models::mesh::{MeshConfig, NamedFile, TexturedMesh};
use cosfly_render::{RenderConfig, Renderer, Scene, SceneMesh, SceneModel, SceneScan, SceneSplats};
use cosfly_scans::faces_and_plates::FacesAndPlates;
use cosfly_splats::SplatCloud;
use cosfly_stage::{Settle, Source, SourceCheck};
use cosfly_town::MapError;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Longest file of splats: the most splats that are read, with every number that they may have, fit well.
const MOST_SPLAT_BYTES: u64 = 4 << 30;
/// Longest file of a mesh, or of a picture beside it.
const MOST_MESH_BYTES: u64 = 4 << 30;
/// Splats farther from the geometry in the median seem to be of another place, metres.
const MOST_OFF_M: f32 = 0.5;
/// A scan whose ground is farther from drawn ground than this seems to be in another light, stops: grounds differ by one.
const MOST_STOPS: f32 = 1.5;
/// More of the pixels of bodies behind splats are a warning.
const MOST_HIDDEN: f64 = 0.1;
/// A mesh with less of its area on the map's boxes and ground seems to be of another place.
const LEAST_KNOWN: f64 = 0.8;
/// Distances from a mesh are told up to this much beyond the certified ones, metres.
const FARTHER_M: f64 = 1.0;
/// Distances from a mesh are good to this much: its corners are 32-bit numbers.
const ROUNDING_M: f64 = 0.01;

/// Files of the models, of the mesh and of the splats, whose paths leave the parameters: what a file holds counts, not where it lies.
pub fn take_sources(config: &mut RenderConfig) -> Vec<Source> {
    let take = |key: String, source: &mut String, settle: Arc<Settle>| {
        let path = std::mem::replace(source, "(content)".into());
        let check =
            SourceCheck { describes: String::new(), read: Arc::new(|_| Ok(Value::Bool(true))), settle: Some(settle) };
        Source { check: Some(check), ..Source::new(key, path) }
    };
    let mut sources = vec![];
    for (index, model) in config.models.iter_mut().enumerate() {
        let check = Arc::new(|path: &Path| read_model(path).map(drop));
        sources.push(take(format!("models.{index}.source"), &mut model.source, check));
    }
    if let Some(mesh) = &mut config.mesh {
        let plain = mesh.clone();
        // Files that the mesh names are found before the mesh is.
        let beside = Arc::new(Mutex::new(vec![]));
        for (index, (file, name)) in mesh.files.iter_mut().zip(plain.names_of_files()).enumerate() {
            let beside = Arc::clone(&beside);
            let check = Arc::new(move |path: &Path| {
                beside.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_owned());
                Ok(())
            });
            let source = take(format!("mesh.files.{index}"), file, check);
            *file = name;
            sources.push(source);
        }
        let check = Arc::new(move |path: &Path| {
            let beside = std::mem::take(&mut *beside.lock().unwrap_or_else(PoisonError::into_inner));
            read_mesh(&plain, path, &beside, DVec3::ZERO).map(drop)
        });
        sources.push(take("mesh.source".to_owned(), &mut mesh.source, check));
    }
    if let Some(splats) = &mut config.splats {
        let check = Arc::new(|path: &Path| read_splats(path).map(drop));
        sources.push(take("splats.source".to_owned(), &mut splats.source, check));
    }
    sources
}

/// Reads the mesh and the splats of a stage from its files, for a town whose labels the mesh has.
///
/// # Errors
/// Files that cannot be read, or are no scan.
pub fn read_scan(config: &RenderConfig, files: &[PathBuf], town: &Town) -> Result<SceneScan> {
    let mesh = read_scene_mesh(config, files, town)?.map(Arc::new);
    let splats = read_scene_splats(config, files, town.origin.offset_m)?.map(Arc::new);
    Ok(SceneScan { mesh, splats })
}

fn read_scene_mesh(config: &RenderConfig, files: &[PathBuf], town: &Town) -> Result<Option<SceneMesh>> {
    let own = config.mesh.as_ref().and_then(|mesh| {
        let files = files.get(config.models.len()..)?;
        Some((mesh, files.get(mesh.files.len())?, &files[..mesh.files.len()]))
    });
    let Some((mesh, file, beside)) = own else { return Ok(None) };
    let read = read_mesh(mesh, file, beside, town.origin.offset_m)?;
    Ok(Some(SceneMesh::new(read, mesh, town)))
}

/// Reads a mesh, whose pictures and materials lie in the files `beside`, those of `config.files` in their order, for a world whose reader took `world_origin_m` off its map.
///
/// # Errors
/// Files that cannot be read, or are no mesh; numbers that no place has.
pub fn read_mesh(config: &MeshConfig, path: &Path, beside: &[PathBuf], world_origin_m: DVec3) -> Result<TexturedMesh> {
    let shown = path.display();
    let refused = |error: MapError| {
        let refused = Diagnostic::new("mesh-refused", Fault::Input, error.message).because(format!("in `{shown}`"));
        error.hints.into_iter().fold(refused, |refused, hint| refused.hint(hint))
    };
    let place = config
        .place(world_origin_m)
        .map_err(|problem| Diagnostic::new("mesh-placed", Fault::Recipe, problem.message).hint(problem.hint))?;
    let read = |path: &Path| {
        let unreadable =
            |error: std::io::Error| Diagnostic::unread(format!("the mesh's file `{}`", path.display()), &error);
        let length = std::fs::metadata(path).map_err(unreadable)?.len();
        if length > MOST_MESH_BYTES {
            let message =
                format!("the file has {length}; at most {MOST_MESH_BYTES} are read", length = counted(length, "byte"));
            return Err(refused(MapError::new(message).hint("cut the scene into pieces, or simplify it")));
        }
        std::fs::read(path).map_err(unreadable)
    };
    let named = |(name, path): (String, &PathBuf)| Ok((name, read(path)?));
    let beside = config.names_of_files().into_iter().zip(beside).map(named).collect::<Result<Vec<NamedFile>>>()?;
    TexturedMesh::read(&read(path)?, &beside, &place).map_err(refused)
}

/// Reads the splats of a stage from its last file, for a town whose reader took `world_origin_m` off its map's points.
fn read_scene_splats(config: &RenderConfig, files: &[PathBuf], world_origin_m: DVec3) -> Result<Option<SceneSplats>> {
    let (Some(splats), Some(file)) = (&config.splats, files.last()) else { return Ok(None) };
    let placed = SceneSplats::new(read_splats(file)?, splats, world_origin_m);
    placed
        .map(Some)
        .map_err(|problem| Diagnostic::new("splats-placed", Fault::Recipe, problem.message).hint(problem.hint))
}

fn read_splats(path: &Path) -> Result<SplatCloud> {
    let shown = path.display();
    let unreadable = |error: std::io::Error| Diagnostic::unread(format!("the splats `{shown}`"), &error);
    let length = std::fs::metadata(path).map_err(unreadable)?.len();
    if length > MOST_SPLAT_BYTES {
        let message =
            format!("the file has {length}; at most {MOST_SPLAT_BYTES} are read", length = counted(length, "byte"));
        let refused = Diagnostic::new("splats-refused", Fault::Input, message).because(format!("in `{shown}`"));
        return Err(refused.hint("cut the scene into pieces, or prune it in an editor of splats such as SuperSplat"));
    }
    let bytes = std::fs::read(path).map_err(unreadable)?;
    cosfly_splats::read(&bytes).map(|file| file.cloud).map_err(|error| {
        let refused = Diagnostic::new("splats-refused", Fault::Input, error.message).because(format!("in `{shown}`"));
        error.hints.into_iter().fold(refused, |refused, hint| refused.hint(hint))
    })
}

/// Reads the models of a stage from its files.
///
/// # Errors
/// Files that cannot be read, or are no models.
pub fn read_models(config: &RenderConfig, files: &[PathBuf]) -> Result<Vec<SceneModel>> {
    let read = |(model, file): (&cosfly_models::ModelConfig, &PathBuf)| {
        let turn_rad = model.turn_deg.to_radians();
        Ok(SceneModel { kind: model.kind, fit: model.fit, turn_rad, model: read_model(file)? })
    };
    config.models.iter().zip(files).map(read).collect()
}

fn read_model(path: &Path) -> Result<Model> {
    let shown = path.display();
    let bytes = std::fs::read(path).map_err(|error| Diagnostic::unread(format!("the model `{shown}`"), &error))?;
    Model::read(&bytes).map_err(|error| {
        let refused = Diagnostic::new("model-refused", Fault::Input, error.message).because(format!("in `{shown}`"));
        error.hints.into_iter().fold(refused, |refused, hint| refused.hint(hint))
    })
}

/// Words on the scans of pictures for the card of a dataset, and warnings where a licence, or what became of faces, is not stated.
pub fn scan_notes(config: &RenderConfig) -> (Vec<String>, Vec<String>) {
    let mesh = config.mesh.as_ref().map(|it| ("mesh", "a textured mesh", &it.license, it.faces_and_plates));
    let splats = config.splats.as_ref().map(|it| ("splats", "splats", &it.license, it.faces_and_plates));
    let (mut notes, mut warnings) = (vec![], vec![]);
    let is_in_air = config
        .weather
        .all()
        .into_iter()
        .any(|(name, range, _)| range.is_some() && dry_days::IN_THE_AIR.contains(&name));
    let air = if is_in_air { "; rain and haze are in the air alone: its ground stays dry" } else { "" };
    let is_lit = config.mesh.as_ref().is_some_and(|mesh| !mesh.light.is_of_scan());
    for (key, what, license, faces) in mesh.into_iter().chain(splats) {
        let sun = if is_lit && key == "mesh" { "; its light is that of each picture's weather" } else { "" };
        let stated = license.as_deref().map(str::trim).filter(|license| !license.is_empty());
        if stated.is_none() {
            warnings.push(format!("the licence of the scan is not stated: give it with `{key}.license`"));
        }
        if faces.is_none() {
            warnings.push(format!(
                "nobody says whether faces and number plates can be told in the scan: give `{key}.faces_and_plates`, `none`, `removed` \
                 or `readable`"
            ));
        }
        let license = stated.unwrap_or("not stated");
        let faces = faces.map_or("not stated", FacesAndPlates::words);
        notes.push(format!(
            "not invented: pictures show {what} of a real or modelled place, licence: {license}; faces and number plates: {faces}; whoever \
             publishes them answers for these{sun}{air}"
        ));
    }
    (notes, warnings)
}

/// Figures of a scan in the frames of a film.
#[derive(Clone, Debug, Default)]
pub struct ScanTally {
    /// Median distances from the geometry by frame, metres.
    off_m: Vec<f32>,
    /// Pixels of bodies that splats hide, and all pixels of bodies.
    hidden: [u64; 2],
    /// How much brighter the scan's ground is than ground is drawn, by frame, stops.
    brighter_stops: Vec<f32>,
}

impl ScanTally {
    /// Adds the frame that was drawn last.
    pub fn add(&mut self, renderer: &Renderer) {
        self.off_m.extend(renderer.splats_off_m());
        self.brighter_stops.extend(renderer.scan_brighter_stops());
        let hidden = renderer.hidden_by_splats();
        self.hidden.iter_mut().zip(hidden).for_each(|(sum, pixels)| *sum += pixels as u64);
    }
}

/// The median of some numbers; none of none.
fn median(numbers: &[f32]) -> Option<f32> {
    let mut sorted = numbers.to_vec();
    sorted.sort_unstable_by(f32::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// Notes on the scan of a film by their names, and warnings where it does not belong to the geometry of the map and of the flight.
pub fn compared(
    config: &RenderConfig,
    scene: &Scene,
    flight: &Trajectory,
    seen: &ScanTally,
) -> (BTreeMap<String, String>, Vec<String>) {
    let mesh = scene.mesh().map(|mesh| {
        let remarks = mesh.remarks().iter().map(|remark| (remark.clone(), Some(format!("the mesh: {remark}"))));
        ("mesh", [vec![matched(mesh), kept_away(mesh, flight)], remarks.collect()].concat())
    });
    let splats =
        config.splats.as_ref().map(|_| ("splats", vec![lying(median(&seen.off_m)), hiding(seen.hidden), bright(seen)]));
    let (mut notes, mut warnings) = (BTreeMap::new(), vec![]);
    for (name, found) in mesh.into_iter().chain(splats) {
        let words: Vec<String> = found.iter().map(|(note, _)| note.clone()).collect();
        notes.insert(name.to_owned(), words.join("; "));
        warnings.extend(found.into_iter().filter_map(|(_, warning)| warning));
    }
    (notes, warnings)
}

/// The note about a flight and the triangles of a mesh, and the warning where it comes nearer than is certified.
fn kept_away(mesh: &SceneMesh, flight: &Trajectory) -> (String, Option<String>) {
    let certified_m = flight.certificate.min_clearance_m;
    let path: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
    let most_m = certified_m + FARTHER_M;
    let away_m = mesh.clearance_m(&path, most_m);
    let word = if away_m < most_m { "" } else { "more than " };
    let note = format!("the flight stays {word}{away_m:.2} m away from them, {certified_m:.2} m are certified");
    let warning = format!(
        "the flight comes within {away_m:.2} m of the mesh, its certificate says {certified_m:.2} m: the map's boxes do not hold all of \
         the mesh; read the map from the same file, and check `mesh.origin_m`"
    );
    (note, (away_m < certified_m - ROUNDING_M).then_some(warning))
}

/// The note about splats and geometry, and the warning where they do not belong together.
fn lying(off_m: Option<f32>) -> (String, Option<String>) {
    let Some(off_m) = off_m else {
        let note = "no picture shows splats over the geometry".to_owned();
        let warning = format!("{note}: check `splats.up_axis`, its scale and its place");
        return (note, Some(warning));
    };
    let note = format!("half of the pixels within {off_m:.2} m of the geometry");
    let is_elsewhere = off_m > MOST_OFF_M;
    let warning = format!(
        "the splats lie {off_m:.1} m from the geometry in the median: check `splats.up_axis`, its scale and its place"
    );
    (note, is_elsewhere.then_some(warning))
}

/// The note about the light of splats beside that of bodies, and the warning where they are far apart.
fn bright(seen: &ScanTally) -> (String, Option<String>) {
    let Some(stops) = median(&seen.brighter_stops) else {
        return ("too little ground to compare its light".to_owned(), None);
    };
    let side = if stops < 0.0 { "darker" } else { "brighter" };
    let note = format!("its ground is {:.1} stops {side} than ground is drawn in this light", stops.abs());
    let warning = format!(
        "{note}: bodies seem to stand in another light; make `splats.exposure_ev` {:.1} {}, or give the weather of the scan",
        stops.abs(),
        if stops < 0.0 { "more" } else { "less" }
    );
    (note, (stops.abs() > MOST_STOPS).then_some(warning))
}

/// The note about bodies that splats hide, and the warning where they are many.
fn hiding([hidden, all]: [u64; 2]) -> (String, Option<String>) {
    let share = hidden as f64 / all.max(1) as f64;
    let note = format!("splats hide {:.1} % of the pixels of bodies", 100.0 * share);
    let warning = format!(
        "{note}: the map lacks what stands there; pictures and labels show them hidden, and flights do not know it. Give a map that has \
         these things, or crop them from the splats"
    );
    (note, (share > MOST_HIDDEN).then_some(warning))
}

/// The note about a mesh and the geometry, and the warning where they do not belong together.
fn matched(mesh: &SceneMesh) -> (String, Option<String>) {
    let share = mesh.known_share();
    let note =
        format!("{} triangles, {:.1} % of their area on the map's boxes and ground", mesh.triangles(), 100.0 * share);
    let warning = format!(
        "{:.0} % of the mesh lie on no box and no ground of the map: check `mesh.up_axis`, its unit and its place",
        100.0 * (1.0 - share)
    );
    (note, (share < LEAST_KNOWN).then_some(warning))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splats_that_lie_elsewhere_or_nowhere_are_a_warning() {
        assert_eq!(lying(Some(0.04)), ("half of the pixels within 0.04 m of the geometry".to_owned(), None));
        let warning = |off_m| lying(off_m).1.expect("a warning");
        assert!(warning(Some(2.0)).contains("2.0 m") && warning(None).contains("splats.up_axis"));
        assert_eq!(hiding([0, 0]), ("splats hide 0.0 % of the pixels of bodies".to_owned(), None));
        assert_eq!(hiding([9, 100]).1, None);
        let seen = |stops: &[f32]| ScanTally { brighter_stops: stops.to_vec(), ..ScanTally::default() };
        assert_eq!(bright(&seen(&[])).1, None);
        let (note, warning) = bright(&seen(&[0.4, -9.0, 1.2]));
        assert!(note.contains("0.4 stops brighter") && warning.is_none(), "{note}");
        let (_, warning) = bright(&seen(&[-2.0; 3]));
        assert!(warning.is_some_and(|it| it.contains("`splats.exposure_ev` 2.0 more")));
        assert!(hiding([11, 100]).1.is_some_and(|it| it.contains("11.0 %")));
    }
}

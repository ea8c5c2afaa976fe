//! Datasets of cosfly: tables, then a stretch of frames of every log.

use crate::walls::{self, Walls};
use cosfly_diagnose::{Diagnostic, Fault, Result, Stop};
use cosfly_domain::{BodyKind, Colour, TARGET_INSTANCE};
use cosfly_episodes::episode::{OFFSETS, depth_in_box, stretch};
use cosfly_episodes::whole_files::{log_problem, parquet_problem};
use cosfly_episodes::{ExaminedEpisode, ExaminedLook, ExaminedMoment, Flag};
use cosfly_fingerprint::Digest;
use cosfly_frames::DVec3;
use cosfly_metrics::drawn_ground::DrawnGround;
use cosfly_read::{BoxInWorld, CaptionReader, FrameRow, LoggedFrame, PublishedDataset, PublishedFlight};
use cosfly_schema::tables::Pairs;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Flights whose logs are read side by side.
const TOGETHER: usize = 32;

/// Distance within which a camera is where a row says, metres: poses in logs are those of the tables to rounding.
const IN_PLACE_M: f64 = 0.01;

/// An episode without its looks, its flight, and the frames of the flight.
type Read = (ExaminedEpisode, PublishedFlight, Vec<FrameRow>);

/// Faults of the files. Each is read to its end, with its checksums.
///
/// # Errors
/// Refusals of the machine where the folder cannot be listed.
pub fn files(folder: &Path, stop: &Stop) -> Result<Vec<Flag>> {
    let fault = |path: &PathBuf| {
        let name = path.strip_prefix(folder).unwrap_or(path).display().to_string();
        if name.ends_with(".parquet") {
            Some(Flag::damage("parquet-damaged", name, parquet_problem(path, stop)?))
        } else if name.ends_with(".mcap") {
            Some(Flag::damage("log-damaged", name, log_problem(path, stop)?))
        } else {
            None
        }
    };
    Ok(cosfly_episodes::files_below(folder)?.par_iter().filter_map(fault).collect())
}

/// Gives all flights to `visit`, one at a time; logs that cannot be read were flagged by [`files`] and are passed over. Where
/// tables are damaged, a flag says so and flights have no frames.
///
/// # Errors
/// Refusals of the machine.
pub fn episodes(
    folder: &Path,
    flags: &mut Vec<Flag>,
    visit: &mut dyn FnMut(ExaminedEpisode),
    (stop, progress): (&Stop, &mut dyn FnMut(u64, u64)),
) -> Result<()> {
    let mut damaged = |refusal: Box<Diagnostic>| match refusal.fault {
        Fault::Machine => Err(refusal),
        _ => {
            let message = [vec![refusal.message], refusal.causes].concat().join(": ");
            flags.push(Flag::damage("tables-damaged", "data", message));
            Ok(())
        }
    };
    let dataset = match PublishedDataset::open(folder) {
        Ok(dataset) => dataset,
        Err(refusal) => return damaged(refusal),
    };
    let mut read_ones: BTreeSet<(String, String)> = BTreeSet::new();
    let outcome = read(&dataset, (stop, progress), &mut |episode| {
        read_ones.insert((episode.id.clone(), episode.split.clone().unwrap_or_default()));
        visit(episode);
    });
    outcome.or_else(&mut damaged)?;
    // Flights without frames and those that are in two tables: they count for leaks.
    for flight in dataset.flights() {
        if read_ones.insert((flight.trajectory_id.clone(), flight.split.clone())) {
            visit(ExaminedEpisode { dt_s: flight.dt_s, ..named(flight) });
        }
    }
    Ok(())
}

/// Gives all flights with their frames to `visit`.
fn read(
    dataset: &PublishedDataset,
    (stop, progress): (&Stop, &mut dyn FnMut(u64, u64)),
    visit: &mut dyn FnMut(ExaminedEpisode),
) -> Result<()> {
    let mut captions = CaptionReader::of(dataset)?;
    let mut vehicles: BTreeMap<String, Vec<BoxInWorld>> = BTreeMap::new();
    let mut walls: BTreeMap<String, Walls> = BTreeMap::new();
    for object in dataset.objects(&["car", "building", "wall"])? {
        match object.kind.as_str() {
            "car" => vehicles.entry(object.town).or_default().push(object.shape),
            _ => walls.entry(object.town).or_default().entry(object.instance).or_default().push(object.shape),
        }
    }
    let displaced = displacements(dataset)?;
    let logged = |(mut episode, flight, rows): Read| {
        episode.displaced_m = match &flight.expert_id {
            Some(_) => displaced.get(&flight.trajectory_id).copied(),
            None => Some(0.0),
        };
        episode.vehicles = vehicles.get(&flight.town).cloned().unwrap_or_default();
        let walls = walls.get(&flight.town).filter(|_| episode.camera.is_some());
        episode.looks = looks(dataset, &flight, &rows, walls, stop).unwrap_or_default();
        episode
    };
    let whole = whole_flights(dataset)?;
    let (mut done, all) = (0, dataset.flights().len() as u64);
    let mut visit_all = |together: &mut Vec<Read>| {
        let episodes: Vec<ExaminedEpisode> = std::mem::take(together).into_par_iter().map(logged).collect();
        for episode in episodes {
            progress(done, all);
            done += 1;
            visit(episode);
        }
    };
    let mut together: Vec<Read> = vec![];
    let outcome = dataset.walk(&|_| true, &mut |flight, rows| {
        let mut episode = episode(flight, &rows);
        if !is_whole(flight) {
            episode.whole = whole.get(&flight.flight_id).cloned();
            episode.is_part = true;
        }
        let place = dataset.place(&flight.trajectory_id).unwrap_or_default();
        episode.captions =
            captions.at(dataset, place)?.iter().map(|it| (it.language.clone(), it.text.clone())).collect();
        stop.check("doctor")?;
        together.push((episode, flight.clone(), rows));
        if together.len() == TOGETHER {
            visit_all(&mut together);
        }
        Ok(())
    });
    visit_all(&mut together);
    outcome
}

/// Whether a film has every frame of its flight.
fn is_whole(flight: &PublishedFlight) -> bool {
    flight.every == 1 && flight.begins_ns == 0
}

/// The flights of which a camera films a part, by the film of another camera that has every frame, where there is one: texts are of the
/// whole flight.
fn whole_flights(dataset: &PublishedDataset) -> Result<BTreeMap<String, Arc<ExaminedEpisode>>> {
    let (films, parts): (Vec<_>, Vec<_>) = dataset.flights().iter().partition(|flight| is_whole(flight));
    let parts: BTreeSet<&str> = parts.into_iter().map(|film| film.flight_id.as_str()).collect();
    let wanted: BTreeMap<&str, &str> = (films.into_iter().filter(|film| parts.contains(film.flight_id.as_str())))
        .map(|film| (film.flight_id.as_str(), film.trajectory_id.as_str()))
        .collect();
    let wanted: BTreeSet<&str> = wanted.into_values().collect();
    let mut whole = BTreeMap::new();
    if !wanted.is_empty() {
        dataset.walk(&|flight| wanted.contains(flight.trajectory_id.as_str()), &mut |flight, rows| {
            whole.insert(flight.flight_id.clone(), Arc::new(episode(flight, &rows)));
            Ok(())
        })?;
    }
    Ok(whole)
}

/// Longest displacement of each perturbed trajectory in a single frame, metres: of kind `jumps`; 0 of kinds that could be flown.
fn displacements(dataset: &PublishedDataset) -> Result<BTreeMap<String, f64>> {
    let mut found = BTreeMap::new();
    for (_, path) in dataset.files("pairs")? {
        cosfly_read::read(&path, &mut |rows| {
            for row in 0..rows.len() {
                let jumps = rows.get(Pairs::position_probability, row)?.is_some();
                let displaced_m = if jumps { rows.get(Pairs::max_offset_m, row)? } else { 0.0 };
                found.insert(rows.get(Pairs::perturbed_id, row)?, displaced_m);
            }
            Ok(())
        })?;
    }
    Ok(found)
}

fn named(flight: &PublishedFlight) -> ExaminedEpisode {
    ExaminedEpisode {
        id: flight.trajectory_id.clone(),
        flight: flight.flight_id.clone(),
        split: Some(flight.split.clone()),
        group: flight.pedestrian_id.clone(),
        place: if flight.town_geometry.is_empty() { flight.town.clone() } else { flight.town_geometry.clone() },
        town: flight.town.clone(),
        is_perturbed: flight.expert_id.is_some(),
        ..ExaminedEpisode::default()
    }
}

/// Clothes of the target of a flight.
fn clothes(flight: &PublishedFlight) -> Option<(Colour, Colour, bool)> {
    let (top, trousers, backpack) = flight.target_clothes.as_ref()?;
    let colour = |name: &str| Colour::ALL.into_iter().find(|colour| colour.name() == name);
    Some((colour(top)?, colour(trousers)?, *backpack))
}

fn episode(flight: &PublishedFlight, rows: &[FrameRow]) -> ExaminedEpisode {
    // Lenses that bend and rows that are taken one after the other move what is projected.
    let is_plain = flight.lens.is_none() && flight.readout_s == 0.0;
    let middle = DVec3::Z * (0.5 * flight.target_height_m);
    // Inspections and patrols follow nobody.
    let follows = flight.target_kind.is_some();
    let moment = |it: &FrameRow| {
        let action = it.action_in_world;
        ExaminedMoment {
            time_s: it.time_s,
            drone: it.pose,
            camera: it.camera_pose,
            next_in_world: action.map(|step| it.pose.position_in_world + DVec3::new(step[0], step[1], step[2])),
            turn_deg: action.map(|step| [step[3], step[4], step[5]]),
            target_in_world: follows.then_some(it.target.feet_in_world + middle),
            heading_and_speed: follows.then_some((it.target.heading_rad, it.target.speed_mps)),
            in_image: it.full_box_px.map(|edges| {
                let [left, top, right, bottom] = edges.map(f64::from);
                (0.5 * (left + right), 0.5 * (top + bottom), bottom - top)
            }),
            visible_box: it.visible_box_px.map(|edges| edges.map(f64::from)),
            visible: follows.then_some(it.visible_by_pixels),
            clearance_m: Some(it.clearance_m),
        }
    };
    ExaminedEpisode {
        camera: is_plain.then_some(flight.camera),
        depth_is_along_rays: flight.lens.is_wide(&flight.camera),
        target_height_m: flight.target_height_m,
        is_runner: flight.target_kind.as_deref() == Some(BodyKind::Runner.name()),
        clothes: clothes(flight),
        is_unlike_all: flight.target_clothes.as_ref().map(|_| rows.iter().all(|row| row.look_alikes == 0)),
        dt_s: flight.dt_s,
        limits: flight.limits,
        moments: rows.iter().map(moment).collect(),
        ..named(flight)
    }
}

fn looks(
    dataset: &PublishedDataset,
    flight: &PublishedFlight,
    rows: &[FrameRow],
    walls: Option<&Walls>,
    stop: &Stop,
) -> Result<Vec<ExaminedLook>> {
    let mut log = dataset.log(flight)?;
    let mut looks = vec![];
    for frame in stretch(rows.len()) {
        stop.check("doctor")?;
        let logged = log.frame_with_instances(frame)?;
        // Others may stand in the target's box.
        let is_target = |instance: &u32| *instance == TARGET_INSTANCE;
        let of_target: Vec<f32> = (logged.depth_m.iter().zip(&logged.instance))
            .map(|(depth_m, instance)| if is_target(instance) { *depth_m } else { f32::NAN })
            .collect();
        let depth = |offset: &i64| {
            let row = rows.get(frame.checked_add_signed(*offset as isize)?)?;
            let edges = row.visible_box_px?.map(f64::from);
            let in_box = |depth_m: &[f32]| depth_in_box(depth_m, logged.width as usize, edges);
            in_box(&of_target).or_else(|| in_box(&logged.depth_m))
        };
        let digest = Digest::of(&logged.rgb_file).to_string();
        let elsewhere_m = elsewhere_m(&logged, frame, rows);
        let depth_m = OFFSETS.iter().map(depth).collect();
        let mut look = ExaminedLook { frame, digest, depth_m, elsewhere_m, ..ExaminedLook::default() };
        // Lenses that bend and rows that are taken one after the other show places elsewhere.
        if flight.lens.is_none() && flight.readout_s == 0.0 {
            let row = &rows[frame];
            let ground = DrawnGround {
                camera: &flight.camera,
                pose: &row.camera_pose,
                depth_m: &|at| logged.depth_m.get(at).map(|depth| f64::from(*depth)),
                label: &|at| logged.semantic.get(at).copied(),
            };
            look.rise_m = ground.rise_m(row.target.feet_in_world, flight.target_height_m);
        }
        if let Some(walls) = walls {
            let points = walls::points(&flight.camera, &logged.depth_m, &logged.instance, walls);
            let gap = |offset: &i64| {
                let row = rows.get(frame.checked_add_signed(*offset as isize)?)?;
                walls::middle_gap_m(&points, &row.camera_pose, walls)
            };
            look.walls_m = OFFSETS.iter().map(gap).collect();
        }
        looks.push(look);
    }
    Ok(looks)
}

/// How far the log's camera is from all rows of its flight, where it is apart from them; 0 where it is in its place and the log
/// states other visible pixels of the target.
fn elsewhere_m(logged: &LoggedFrame, frame: usize, rows: &[FrameRow]) -> Option<f64> {
    // `map` is right-handed: y changes its sign.
    let camera_in_world = logged.camera_in_map * DVec3::new(1.0, -1.0, 1.0);
    let away_m = |row: &FrameRow| row.camera_pose.position_in_world.distance(camera_in_world);
    let own = rows.get(frame)?;
    if away_m(own) <= IN_PLACE_M {
        return (logged.target.visible_pixels != own.visible_pixels).then_some(0.0);
    }
    // Poses of other frames are a shift, which has a flag of its own.
    let nearest_m = rows.iter().map(away_m).fold(f64::INFINITY, f64::min);
    (nearest_m > IN_PLACE_M).then_some(nearest_m)
}

//! Checks of every format: time runs forward, nobody jumps, gaps part a track.

use super::{RecordedConfig, RecordedError, RecordedPoint, RecordedTrack, Recording};
use cosfly_frames::{DVec2, real};
use std::collections::BTreeMap;

/// Mean radius of the Earth, metres: good enough to tell a jump.
const EARTH_M: f64 = 6_371_000.0;

/// Parts tracks at jumps and gaps, leaves out repeated points and lone ones.
///
/// # Errors
/// Where a person's time runs backwards, and where no track is left.
pub(super) fn tidy(recording: &mut Recording, config: &RecordedConfig) -> Result<(), RecordedError> {
    let mut counts = Counts::default();
    let mut tracks = vec![];
    let is_untimed = |warning: &String| warning.contains("without a time") || warning.contains("without times");
    let all_are_timed = !recording.warnings.iter().any(is_untimed);
    recording.warnings.extend(shared_name(&recording.tracks));
    for track in std::mem::take(&mut recording.tracks) {
        part(track, recording.is_geographic, config, &mut counts, &mut tracks)?;
    }
    if tracks.is_empty() {
        return Err(counts.nothing_left(config, all_are_timed));
    }
    recording.tracks = tracks;
    recording.warnings.extend(counts.warnings(config));
    Ok(())
}

/// Says so where several tracks have one name: each is a person of its own.
fn shared_name(tracks: &[RecordedTrack]) -> Option<String> {
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    tracks.iter().for_each(|track| *names.entry(&track.id).or_default() += 1);
    let shared: Vec<(&str, usize)> = names.into_iter().filter(|(_, count)| *count > 1).collect();
    let (name, count) = shared.first()?;
    let more = if shared.len() > 1 { format!("; {} more names are shared", shared.len() - 1) } else { String::new() };
    Some(format!(
        "{count} tracks are called `{name}`: each is another person, and `follow.named` means the first{more}"
    ))
}

#[derive(Default)]
struct Counts {
    repeated: usize,
    jumps: usize,
    first_jump: Option<(String, f64, u32)>,
    gaps: usize,
    lone: usize,
}

impl Counts {
    /// Why no track is left.
    fn nothing_left(&self, config: &RecordedConfig, all_are_timed: bool) -> RecordedError {
        if let Some((id, speed_mps, line)) = &self.first_jump {
            let message = format!(
                "no two points of a track follow each other at `max_speed_mps`, {}, or less; the first jump is at {speed_mps:.1} m/s, of `{id}`",
                config.max_speed_mps
            );
            return RecordedError::new(message)
                .at(*line)
                .hint("are the places metres and the times seconds? `rate_hz` is for times in frames");
        }
        let hint = match (self.gaps > 0, all_are_timed) {
            (true, _) => {
                "all points are farther apart in time than `max_gap_s`: set it higher, or `rate_hz = 1000` for times in milliseconds"
            }
            (false, true) => "the file needs at least one person with two points",
            (false, false) => "tracks need a time for each point",
        };
        RecordedError::new("the file has no track with time").hint(hint)
    }

    fn warnings(&self, config: &RecordedConfig) -> Vec<String> {
        let mut warnings = vec![];
        if self.repeated > 0 {
            warnings.push(format!("{} points at the time of the point before are left out", self.repeated));
        }
        if let Some((id, speed_mps, line)) = &self.first_jump {
            let place = if *line > 0 { format!(" (line {line})") } else { String::new() };
            warnings.push(format!(
                "tracks are parted at {} jumps, the first of `{id}` at {speed_mps:.1} m/s{place}; `max_speed_mps` is {}",
                self.jumps, config.max_speed_mps
            ));
        }
        if self.gaps > 0 {
            let longest_s = config.max_gap_s;
            warnings.push(format!("tracks are parted at {} gaps longer than `max_gap_s`, {longest_s} s", self.gaps));
        }
        if self.lone > 0 {
            warnings.push(format!("{} tracks of one point are left out", self.lone));
        }
        warnings
    }
}

fn part(
    track: RecordedTrack,
    is_geographic: bool,
    config: &RecordedConfig,
    counts: &mut Counts,
    tracks: &mut Vec<RecordedTrack>,
) -> Result<(), RecordedError> {
    let mut parts: Vec<Vec<RecordedPoint>> = vec![vec![]];
    let mut last: Option<RecordedPoint> = None;
    for point in track.points {
        if let Some(before) = last {
            let passed_s = point.time_s - before.time_s;
            if passed_s < 0.0 {
                let message = format!("the time of `{}` runs backwards by {:.3} s", track.id, -passed_s);
                return Err(RecordedError::new(message)
                    .at(point.line)
                    .hint("sort the points of each person by time, and give each person an id of their own"));
            }
            if passed_s == 0.0 {
                counts.repeated += 1;
                continue;
            }
            let speed_mps = distance_m(before.at, point.at, is_geographic) / passed_s;
            if speed_mps > config.max_speed_mps {
                counts.jumps += 1;
                counts.first_jump.get_or_insert((track.id.clone(), speed_mps, point.line));
                parts.push(vec![]);
            } else if passed_s > config.max_gap_s {
                counts.gaps += 1;
                parts.push(vec![]);
            }
        }
        last = Some(point);
        if let Some(part) = parts.last_mut() {
            part.push(point);
        }
    }
    for (number, points) in parts.into_iter().enumerate() {
        match points.len() {
            0 => {}
            1 => counts.lone += 1,
            _ => {
                let id = if number == 0 { track.id.clone() } else { format!("{} / {}", track.id, number + 1) };
                tracks.push(RecordedTrack { id, points });
            }
        }
    }
    Ok(())
}

/// Distance of two places, metres; of longitudes and latitudes on a sphere.
fn distance_m(from: DVec2, to: DVec2, is_geographic: bool) -> f64 {
    if !is_geographic {
        return (to - from).length();
    }
    let step = DVec2::new((to.x - from.x) * real::cos(0.5 * (from.y + to.y).to_radians()), to.y - from.y);
    EARTH_M * step.length().to_radians()
}

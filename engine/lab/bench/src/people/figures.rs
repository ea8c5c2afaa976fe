//! [`Figures`]: how people move, from places at 2 Hz alone, so that recorded and simulated people are measured alike.

use cosfly_pedestrians::Recording;
use glam::DVec2;
use serde::Serialize;
use std::collections::BTreeMap;

/// Time between samples, seconds.
pub const SAMPLE_S: f64 = 0.5;

/// Slower than this, a person stands, m/s.
const STANDING_MPS: f64 = 0.2;
/// Directions are read from people faster than this, m/s.
const TURNING_MPS: f64 = 0.5;
/// Samples in eight seconds.
const CHORD: usize = 16;
/// People walk together who are near each other and equally fast for so long: metres, m/s, samples, share of the time.
const TOGETHER_M: f64 = 1.6;
const TOGETHER_MPS: f64 = 0.4;
const TOGETHER_SAMPLES: usize = 8;
const TOGETHER_SHARE: f64 = 0.75;

/// Places of people every half second.
#[derive(Clone, Debug)]
pub struct Tracks {
    /// Name of the set.
    pub name: String,
    /// Number of the first sample, and places in plan, metres.
    pub people: Vec<(u32, Vec<DVec2>)>,
}

/// Figures of a set of tracks.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Name of the set.
    pub name: String,
    /// Number of tracks.
    pub people: usize,
    /// Median speed of each track while it moves: quartiles over the tracks, m/s.
    pub speed_mps: [f64; 3],
    /// Share of the time below 0.2 m/s.
    pub standing_time: f64,
    /// Share of the tracks that stand for more than half of their time.
    pub standing_tracks: f64,
    /// Lengths of stops of a second or more: median and 95 %, seconds.
    pub stop_s: [f64; 2],
    /// Largest deceleration in the three seconds before a stop, median, m/s2.
    pub braking_mps2: f64,
    /// Length of the acceleration of those who move: median and 95 %, m/s2.
    pub acceleration_mps2: [f64; 2],
    /// Heading rate of those faster than 0.5 m/s: median and 95 %, degrees/s.
    pub heading_rate_deg_s: [f64; 2],
    /// Share of these samples below 1 degree/s.
    pub straight: f64,
    /// Largest distance from the chord over eight seconds of walking: quartile and median, metres.
    pub departure_m: [f64; 2],
    /// Share of the people who walk or stand together with somebody.
    pub in_groups: f64,
    /// Distance to the nearest one of those whom somebody is together with: median and 95 %, metres.
    pub apart_m: [f64; 2],
    /// Share of the pairs that come within 3 m that ever come below 0.4 m.
    pub close_pairs: f64,
}

impl Figures {
    /// Measures a set.
    pub fn of(tracks: &Tracks) -> Self {
        let mut samples = Samples::default();
        tracks.people.iter().for_each(|(_, places)| samples.add(places));
        let Company { in_groups, mut apart_m, close_pairs } = company(tracks);
        let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
        let straight = samples.heading_rates_deg_s.iter().filter(|rate| **rate < 1.0).count();
        Self {
            name: tracks.name.clone(),
            people: tracks.people.len(),
            speed_mps: [0.25, 0.5, 0.75].map(|part| quantile(&mut samples.speeds_mps, part)),
            standing_time: share(samples.standing, samples.all),
            standing_tracks: share(samples.standing_tracks, tracks.people.len()),
            stop_s: [0.5, 0.95].map(|part| quantile(&mut samples.stops_s, part)),
            braking_mps2: quantile(&mut samples.brakings_mps2, 0.5),
            acceleration_mps2: [0.5, 0.95].map(|part| quantile(&mut samples.accelerations_mps2, part)),
            straight: share(straight, samples.heading_rates_deg_s.len()),
            heading_rate_deg_s: [0.5, 0.95].map(|part| quantile(&mut samples.heading_rates_deg_s, part)),
            departure_m: [0.25, 0.5].map(|part| quantile(&mut samples.departures_m, part)),
            in_groups,
            apart_m: [0.5, 0.95].map(|part| quantile(&mut apart_m, part)),
            close_pairs,
        }
    }
}

/// The value below which a part of the list lies; not a number where it is empty.
fn quantile(list: &mut [f64], part: f64) -> f64 {
    list.sort_by(f64::total_cmp);
    list.get((part * list.len().saturating_sub(1) as f64).round() as usize).copied().unwrap_or(f64::NAN)
}

#[derive(Default)]
struct Samples {
    all: usize,
    standing: usize,
    standing_tracks: usize,
    speeds_mps: Vec<f64>,
    stops_s: Vec<f64>,
    brakings_mps2: Vec<f64>,
    accelerations_mps2: Vec<f64>,
    heading_rates_deg_s: Vec<f64>,
    departures_m: Vec<f64>,
}

impl Samples {
    fn add(&mut self, places: &[DVec2]) {
        let velocities: Vec<DVec2> = places.windows(2).map(|pair| (pair[1] - pair[0]) / SAMPLE_S).collect();
        let speeds: Vec<f64> = velocities.iter().map(|velocity| velocity.length()).collect();
        let standing = speeds.iter().filter(|speed| **speed < STANDING_MPS).count();
        self.all += speeds.len();
        self.standing += standing;
        self.standing_tracks += usize::from(2 * standing > speeds.len());
        let mut moving: Vec<f64> = speeds.iter().copied().filter(|speed| *speed >= STANDING_MPS).collect();
        if !moving.is_empty() {
            self.speeds_mps.push(quantile(&mut moving, 0.5));
        }
        self.add_stops(&speeds);
        for pair in velocities.windows(2) {
            let [before, after] = [pair[0].length(), pair[1].length()];
            if before.max(after) >= STANDING_MPS {
                self.accelerations_mps2.push((pair[1] - pair[0]).length() / SAMPLE_S);
            }
            if before.min(after) >= TURNING_MPS {
                self.heading_rates_deg_s.push(pair[0].angle_to(pair[1]).abs().to_degrees() / SAMPLE_S);
            }
        }
        for first in (0..places.len().saturating_sub(CHORD)).step_by(CHORD / 4) {
            let window = &places[first..=first + CHORD];
            let Some(along) = (window[CHORD] - window[0]).try_normalize() else { continue };
            if speeds[first..first + CHORD].iter().all(|speed| *speed >= TURNING_MPS) {
                let away = window.iter().map(|place| along.perp_dot(*place - window[0]).abs());
                self.departures_m.push(away.fold(0.0, f64::max));
            }
        }
    }

    /// Stops of a second or more that begin and end within the track, and the braking before them.
    fn add_stops(&mut self, speeds: &[f64]) {
        let mut from = None;
        for (sample, speed) in speeds.iter().chain([&f64::INFINITY]).enumerate() {
            match (from, *speed < STANDING_MPS) {
                (None, true) => from = Some(sample),
                (Some(first), false) => {
                    let length = sample - first;
                    from = None;
                    if length < 2 {
                        continue;
                    }
                    self.stops_s.push(length as f64 * SAMPLE_S);
                    if first >= 6 && speeds[first - 6] > 2.0 * TURNING_MPS {
                        let before = speeds[first - 6..=first].windows(2);
                        let braking = before.map(|pair| (pair[0] - pair[1]) / SAMPLE_S).fold(0.0, f64::max);
                        self.brakings_mps2.push(braking);
                    }
                }
                _ => {}
            }
        }
    }
}

/// Time that two people had together.
#[derive(Default)]
struct Pair {
    near: usize,
    together: usize,
    least_m: f64,
}

/// Pairs of people who walk together.
struct Company {
    /// Share of people in groups.
    in_groups: f64,
    /// Distance of each of them to the nearest companion at each sample, metres.
    apart_m: Vec<f64>,
    /// Share of near pairs that came below 0.4 m.
    close_pairs: f64,
}

fn company(tracks: &Tracks) -> Company {
    let end = tracks.people.iter().map(|(first, places)| *first as usize + places.len()).max().unwrap_or(0);
    let mut pairs: BTreeMap<(usize, usize), Pair> = BTreeMap::new();
    let mut present: Vec<(usize, DVec2, DVec2)> = vec![];
    for sample in 0..end {
        present.clear();
        for (number, (first, places)) in tracks.people.iter().enumerate() {
            let Some(own) = sample.checked_sub(*first as usize).filter(|own| *own < places.len()) else { continue };
            let (before, after) = (own.saturating_sub(1), (own + 1).min(places.len() - 1));
            let velocity = (places[after] - places[before]) / ((after - before).max(1) as f64 * SAMPLE_S);
            present.push((number, places[own], velocity));
        }
        present.sort_by(|a, b| a.1.x.total_cmp(&b.1.x));
        for (rank, one) in present.iter().enumerate() {
            for other in present[rank + 1..].iter().take_while(|other| other.1.x - one.1.x <= 3.0) {
                let distance_m = (other.1 - one.1).length();
                if distance_m > 3.0 {
                    continue;
                }
                let key = (one.0.min(other.0), one.0.max(other.0));
                let pair = pairs.entry(key).or_insert(Pair { least_m: f64::INFINITY, ..Pair::default() });
                pair.near += 1;
                let is_together = distance_m <= TOGETHER_M && (other.2 - one.2).length() <= TOGETHER_MPS;
                pair.together += usize::from(is_together);
                pair.least_m = pair.least_m.min(distance_m);
            }
        }
    }
    let mut companions = vec![vec![]; tracks.people.len()];
    for ((one, other), pair) in &pairs {
        let common = common_samples(&tracks.people[*one], &tracks.people[*other]);
        if pair.together >= TOGETHER_SAMPLES && pair.together as f64 >= TOGETHER_SHARE * common as f64 {
            companions[*one].push(*other);
            companions[*other].push(*one);
        }
    }
    let place = |number: usize, sample: usize| {
        let (first, places) = &tracks.people[number];
        places.get(sample.checked_sub(*first as usize)?).copied()
    };
    let mut apart_m = vec![];
    for (one, others) in companions.iter().enumerate() {
        apart_m.extend((0..end).filter_map(|sample| {
            let own = place(one, sample)?;
            let distances = others.iter().filter_map(|other| Some((place(*other, sample)? - own).length()));
            distances.min_by(f64::total_cmp)
        }));
    }
    let close = pairs.values().filter(|pair| pair.least_m < 0.4).count();
    let grouped = companions.iter().filter(|others| !others.is_empty()).count();
    Company {
        in_groups: grouped as f64 / tracks.people.len().max(1) as f64,
        apart_m,
        close_pairs: close as f64 / pairs.len().max(1) as f64,
    }
}

/// Samples at which both are present.
fn common_samples(one: &(u32, Vec<DVec2>), other: &(u32, Vec<DVec2>)) -> usize {
    let end = |it: &(u32, Vec<DVec2>)| it.0 as usize + it.1.len();
    end(one).min(end(other)).saturating_sub(one.0.max(other.0) as usize)
}

impl Tracks {
    /// Tracks of a recording, metres.
    pub fn of_recording(name: &str, recording: &Recording) -> Self {
        let first_s = recording.tracks.iter().flat_map(|track| track.points.first()).map(|point| point.time_s);
        let from_s = first_s.fold(f64::INFINITY, f64::min);
        let people = recording.tracks.iter().map(|track| track.sampled(from_s, SAMPLE_S));
        Self { name: name.to_owned(), people: people.filter(|(_, places)| places.len() > 1).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_a_walk_with_one_stop_are_those_by_hand() {
        // 20 s at 1 m/s, 5 s standing, 20 s at 1 m/s, and a second person 0.8 m beside.
        let mut x = 0.0;
        let mut walk = vec![DVec2::ZERO];
        for sample in 0..90 {
            x += if (40..50).contains(&sample) { 0.0 } else { 0.5 };
            walk.push(DVec2::new(x, 0.0));
        }
        let beside = walk.iter().map(|place| *place + 0.8 * DVec2::Y).collect();
        let figures = Figures::of(&Tracks { name: "two".into(), people: vec![(0, walk), (0, beside)] });
        assert_eq!(figures.speed_mps, [1.0; 3]);
        assert!((figures.standing_time - 10.0 / 90.0).abs() < 1e-12);
        assert_eq!(figures.stop_s, [5.0, 5.0]);
        assert!(figures.braking_mps2.is_nan(), "braking counts above 1 m/s");
        assert_eq!((figures.in_groups, figures.close_pairs, figures.straight), (1.0, 0.0, 1.0));
        assert_eq!(figures.departure_m, [0.0, 0.0]);
        assert!(figures.apart_m.iter().all(|apart_m| (apart_m - 0.8).abs() < 1e-12));
    }
}

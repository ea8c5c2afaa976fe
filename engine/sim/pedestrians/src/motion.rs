//! From a path to frames: curvature-dependent speed, random stops, arc-length time, fixed steps (paper, appendix,
//! "Pedestrian Variable-Speed Mechanism").

use crate::PedestrianConfig;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// Distance between the points at which the speed law is evaluated, metres; also half the span over which
/// curvature is measured: people turn with their whole body, not at a point.
const KNOT_M: f64 = 0.5;

/// A pause on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stop {
    /// Place along the path, metres.
    pub at_m: f64,
    /// Duration, seconds.
    pub duration_s: f64,
}

/// One frame of the motion, still in plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MotionFrame {
    pub position: DVec2,
    pub heading_rad: f64,
    pub speed_mps: f64,
    pub standing: bool,
}

/// A path by arc length.
pub(crate) struct ArcPath {
    points: Vec<DVec2>,
    arc_m: Vec<f64>,
}

impl ArcPath {
    /// From points of which no two neighbours coincide; at least one.
    pub fn new(points: Vec<DVec2>) -> Self {
        let mut arc_m = Vec::with_capacity(points.len());
        let mut sum = 0.0;
        for i in 0..points.len() {
            sum += if i == 0 { 0.0 } else { (points[i] - points[i - 1]).length() };
            arc_m.push(sum);
        }
        Self { points, arc_m }
    }

    pub fn length_m(&self) -> f64 {
        self.arc_m.last().copied().unwrap_or_default()
    }

    /// The point at arc length `s_m`, on the chord between two points of the path.
    pub fn at(&self, s_m: f64) -> DVec2 {
        let after = self.arc_m.partition_point(|&arc| arc <= s_m).clamp(1, self.points.len().max(2) - 1);
        let (Some(&from), Some(&to)) = (self.points.get(after - 1), self.points.get(after)) else {
            return self.points.first().copied().unwrap_or_default();
        };
        let length = self.arc_m[after] - self.arc_m[after - 1];
        let share = if length > 0.0 { ((s_m - self.arc_m[after - 1]) / length).clamp(0.0, 1.0) } else { 0.0 };
        from + share * (to - from)
    }

    /// Direction of the path around `s_m`, radians.
    pub fn heading_rad(&self, s_m: f64) -> f64 {
        let ahead = self.at((s_m + 0.5 * KNOT_M).min(self.length_m()));
        let step = ahead - self.at((s_m - 0.5 * KNOT_M).max(0.0));
        real::atan2(step.y, step.x)
    }
}

/// Menger curvature of three points: 4 x area / product of the sides, 1/m.
fn menger_curvature(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let sides = (b - a).length() * (c - b).length() * (c - a).length();
    let doubled_area = (b - a).perp_dot(c - a).abs();
    if sides > 1e-12 {
        2.0 * doubled_area / sides
    } else if (b - a).length() > 1e-6 {
        // There and back again: the sharpest turn there is at this scale.
        2.0 / (b - a).length()
    } else {
        0.0
    }
}

/// Speed at every knot: clip(cruise / (1 + alpha kappa) (1 + beta U(-1, 1)), limits).
pub(crate) fn knot_speeds(path: &ArcPath, config: &PedestrianConfig, cruise_mps: f64, seed: Seed) -> Vec<f64> {
    let mut noise = seed.stream("speed");
    let count = (path.length_m() / KNOT_M).ceil() as usize + 1;
    (0..count)
        .map(|knot| {
            let s_m = knot as f64 * KNOT_M;
            let inner = s_m >= KNOT_M && s_m + KNOT_M <= path.length_m();
            let curvature =
                if inner { menger_curvature(path.at(s_m - KNOT_M), path.at(s_m), path.at(s_m + KNOT_M)) } else { 0.0 };
            let vary = 1.0 + config.speed_variation_share * noise.uniform(-1.0, 1.0);
            (cruise_mps / (1.0 + config.turn_slowdown_m * curvature) * vary)
                .clamp(config.speed.min_mps, config.speed.max_mps)
        })
        .collect()
}

/// Random stops: exponential distances between them, uniform durations. A stop at a place where
/// standing is not allowed (`may_stand` is false) moves on to the next place where it is.
pub(crate) fn random_stops(
    length_m: f64,
    config: &PedestrianConfig,
    seed: Seed,
    may_stand: &dyn Fn(f64) -> bool,
) -> Vec<Stop> {
    let mut stream: RandomStream = seed.stream("stops");
    let mut stops = vec![];
    if config.stops.per_100m <= 0.0 || config.stops.max_s <= 0.0 {
        return stops;
    }
    let mut at_m = 0.0;
    loop {
        at_m -= 100.0 / config.stops.per_100m * real::ln(1.0 - stream.unit());
        let duration_s = stream.uniform(config.stops.min_s, config.stops.max_s);
        while at_m < length_m && !may_stand(at_m) {
            at_m += KNOT_M;
        }
        // Absurdly rare stops give a distance that is not a number.
        if at_m.is_nan() || at_m >= length_m {
            return stops;
        }
        stops.push(Stop { at_m, duration_s });
    }
}

/// Time against arc length: breakpoints (time, arc length, standing until the next breakpoint).
fn timeline(path: &ArcPath, speeds: &[f64], stops: &[Stop]) -> Vec<(f64, f64, bool)> {
    let mut points = vec![(0.0, 0.0, false)];
    let mut stops = stops.iter().peekable();
    let mut time_s = 0.0;
    for (knot, pair) in speeds.windows(2).enumerate() {
        let from_m = knot as f64 * KNOT_M;
        let to_m = (from_m + KNOT_M).min(path.length_m());
        // Trapezoid rule over the slowness 1/v.
        let slowness = 0.5 * (1.0 / pair[0] + 1.0 / pair[1]);
        let mut here_m = from_m;
        while let Some(stop) = stops.next_if(|stop| stop.at_m < to_m) {
            time_s += (stop.at_m - here_m) * slowness;
            here_m = stop.at_m;
            points.push((time_s, here_m, true));
            time_s += stop.duration_s;
            points.push((time_s, here_m, false));
        }
        time_s += (to_m - here_m) * slowness;
        points.push((time_s, to_m, false));
    }
    points
}

/// The first `steps` frames at `dt_s`; `None` when the path ends before and `stand_at_end` is false.
pub(crate) fn frames(
    path: &ArcPath,
    speeds: &[f64],
    stops: &[Stop],
    config: &PedestrianConfig,
    stand_at_end: bool,
) -> Option<Vec<MotionFrame>> {
    let timeline = timeline(path, speeds, stops);
    let mut next = 1;
    let mut frames = Vec::with_capacity(config.frames as usize);
    for frame in 0..config.frames {
        let time_s = f64::from(frame) * config.dt_s;
        while next < timeline.len() && timeline[next].0 <= time_s {
            next += 1;
        }
        let (s_m, standing) = match timeline.get(next) {
            Some(&(end_s, end_m, _)) => {
                let (start_s, start_m, standing) = timeline[next - 1];
                (start_m + (end_m - start_m) * ((time_s - start_s) / (end_s - start_s)), standing)
            }
            None if stand_at_end => (path.length_m(), true),
            None => return None,
        };
        let knot = ((s_m / KNOT_M) as usize).min(speeds.len().saturating_sub(2));
        let speed_mps = match (standing, speeds.get(knot..knot + 2)) {
            (false, Some(pair)) => pair[0] + (pair[1] - pair[0]) * (s_m / KNOT_M - knot as f64).clamp(0.0, 1.0),
            _ => 0.0,
        };
        frames.push(MotionFrame { position: path.at(s_m), heading_rad: path.heading_rad(s_m), speed_mps, standing });
    }
    Some(frames)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seed() -> Seed {
        Seed::of_item(5, "walkers", "motion")
    }

    fn quiet() -> PedestrianConfig {
        let mut config = PedestrianConfig { speed_variation_share: 0.0, ..PedestrianConfig::default() };
        config.stops.per_100m = 0.0;
        config
    }

    fn straight(length_m: f64) -> ArcPath {
        ArcPath::new((0..=(length_m / 0.05) as usize).map(|i| DVec2::new(0.05 * i as f64, 0.0)).collect())
    }

    #[test]
    fn menger_curvature_of_a_circle_is_one_over_its_radius() {
        let on_circle = |angle: f64| 4.0 * DVec2::new(real::cos(angle), real::sin(angle));
        assert!((menger_curvature(on_circle(0.0), on_circle(0.2), on_circle(0.5)) - 0.25).abs() < 1e-12);
        assert_eq!(menger_curvature(DVec2::ZERO, DVec2::X, 2.0 * DVec2::X), 0.0);
    }

    #[test]
    fn a_straight_walk_at_constant_speed_takes_length_over_speed() {
        let (path, config) = (straight(130.0), quiet());
        let speeds = knot_speeds(&path, &config, 1.25, seed());
        let frames = frames(&path, &speeds, &[], &config, false).unwrap();
        assert_eq!(frames.len(), 200);
        for (i, frame) in frames.iter().enumerate() {
            assert!((frame.position.x - 1.25 * 0.5 * i as f64).abs() < 1e-9);
            assert_eq!((frame.speed_mps, frame.standing), (1.25, false));
        }
    }

    #[test]
    fn a_bend_slows_the_walk_by_the_law() {
        // Straight, then a circle of 2 m radius: v = 1.3 / (1 + 1.0 * 0.5).
        let mut points: Vec<DVec2> = (0..200).map(|i| DVec2::new(-10.0 + 0.05 * i as f64, 0.0)).collect();
        points.extend((0..400).map(|i| {
            let angle = 0.02 * i as f64;
            DVec2::new(2.0 * real::sin(angle), 2.0 - 2.0 * real::cos(angle))
        }));
        let path = ArcPath::new(points);
        let speeds = knot_speeds(&path, &quiet(), 1.3, seed());
        assert!((speeds[10] - 1.3).abs() < 1e-9);
        assert!((speeds[30] - 1.3 / 1.5).abs() < 1e-3, "{}", speeds[30]);
    }

    #[test]
    fn stops_last_as_long_as_asked_and_do_not_move() {
        let (path, mut config) = (straight(60.0), quiet());
        config.frames = 120;
        let speeds = knot_speeds(&path, &config, 1.0, seed());
        let stops = [
            Stop { at_m: 10.2, duration_s: 4.0 },
            Stop { at_m: 10.2, duration_s: 3.0 },
            Stop { at_m: 30.0, duration_s: 6.0 },
        ];
        let frames = frames(&path, &speeds, &stops, &config, true).unwrap();
        let standing_s = |low: f64, high: f64| {
            frames.iter().filter(|f| f.standing && (low..high).contains(&f.position.x)).count() as f64 * config.dt_s
        };
        assert!((standing_s(10.0, 11.0) - 7.0).abs() <= 0.5);
        assert!((standing_s(29.0, 31.0) - 6.0).abs() <= 0.5);
        let at_stop: Vec<_> = frames.iter().filter(|f| f.standing).map(|f| f.position.x).collect();
        assert!(at_stop.iter().all(|x| (x - 10.2).abs() < 1e-9 || (x - 30.0).abs() < 1e-9), "{at_stop:?}");
        assert!(frames.iter().all(|f| f.standing == (f.speed_mps == 0.0)));
    }

    #[test]
    fn stops_come_as_often_as_asked_and_never_where_nobody_should_stand() {
        let mut config = PedestrianConfig::default();
        config.stops.per_100m = 4.0;
        let stops = random_stops(50_000.0, &config, seed(), &|s| !((s / 10.0) as u64).is_multiple_of(3));
        assert!((1500..2200).contains(&stops.len()), "{}", stops.len());
        assert!(stops.iter().all(|stop| !((stop.at_m / 10.0) as u64).is_multiple_of(3)));
        assert!(stops.iter().all(|stop| (2.0..=8.0).contains(&stop.duration_s)));
        let mean = stops.iter().map(|stop| stop.duration_s).sum::<f64>() / stops.len() as f64;
        assert!((mean - 5.0).abs() < 0.2, "{mean}");
    }

    #[test]
    fn absurdly_rare_stops_never_come() {
        let mut config = PedestrianConfig::default();
        for per_100m in [0.0, f64::MIN_POSITIVE, 1e-308 / 4.0] {
            config.stops.per_100m = per_100m;
            for item in 0..20 {
                assert_eq!(random_stops(1000.0, &config, Seed::of_item(item, "s", "i"), &|_| true), vec![]);
            }
        }
    }

    #[test]
    fn a_path_that_ends_early_says_so_or_ends_standing() {
        let (path, config) = (straight(20.0), quiet());
        let speeds = knot_speeds(&path, &config, 1.3, seed());
        assert_eq!(frames(&path, &speeds, &[], &config, false), None);
        let ended = frames(&path, &speeds, &[], &config, true).unwrap();
        assert!(ended[199].standing && (ended[199].position.x - 20.0).abs() < 1e-9);
        assert!(ended[199].heading_rad.abs() < 1e-9);
    }
}

//! `cosfly-lab geometry`: rays and distances per second of cosfly's box tree, of other libraries' trees and of a
//! brute-force loop.

use crate::clock::{thread_cpu_s, timed};
use crate::geometry_contenders::{Contender, Obvhs2, ObvhsCw, Parry, ParryWalk};
use crate::geometry_scenes::{BenchTown, RAYS, View};
use crate::median::median;
use cosfly_frames::DVec3;
use cosfly_frames::simd::Level;
use cosfly_geometry::{BoxBvh, BruteForce, SpatialQuery};
use serde::Serialize;
use std::fmt;
use std::hint::black_box;

/// Numbers of boxes of the towns.
pub const SIZES: [usize; 4] = [50, 200, 2_000, 65_000];
/// Rounds of every measurement; contenders take turns.
const ROUNDS: usize = 7;
/// CPU time of one contender's part of a round, seconds.
const SLICE_S: f64 = 1.5e-3;
/// Views on which the brute-force loop checks cosfly's answers.
const CHECKED_VIEWS: usize = 128;

/// Table of all towns.
#[derive(Clone, Debug, Serialize)]
pub struct GeometryTable {
    /// Seed of the towns.
    pub seed: u64,
    /// Vector instructions in use.
    pub level: &'static str,
    /// Rows, one per town.
    pub rows: Vec<GeometryRow>,
}

/// Measurements in one town.
#[derive(Clone, Debug, Serialize)]
pub struct GeometryRow {
    /// Number of boxes of the town.
    pub boxes: usize,
    /// Whether the boxes are rotated.
    pub turned: bool,
    /// Views with at least five of eight rays hidden.
    pub hidden: RayFigures,
    /// Views with at most one ray hidden.
    pub free: RayFigures,
    /// Distance queries within 50 m, millions per second.
    pub distances: Vec<Figure>,
    /// Clearance queries of segments of two metres, capped at 5 m, millions per second.
    pub segments: Vec<Figure>,
    /// Build time, microseconds.
    pub build_us: Vec<Figure>,
}

/// Ray queries in one set of views.
#[derive(Clone, Debug, Serialize)]
pub struct RayFigures {
    /// Number of rays of the set.
    pub rays: usize,
    /// Share of occluded rays.
    pub hidden_share: f64,
    /// Rays, millions per second.
    pub rates: Vec<Figure>,
    /// Number of rays on which a contender and cosfly disagree, by f32 rounding of grazing rays.
    pub disagreements: Vec<Figure>,
    /// Number of rays on which cosfly and the brute-force f64 loop disagree.
    pub wrong: usize,
}

/// A figure of a contender.
#[derive(Clone, Debug, Serialize)]
pub struct Figure {
    /// Name of the contender.
    pub name: &'static str,
    /// Value of the figure.
    pub value: f64,
}

/// Names of cosfly's queries in the tables.
const OURS: &str = "cosfly";
const OURS_EIGHT: &str = "cosfly, 8 rays";
const LOOP: &str = "plain loop f64";

/// Measures everything; takes some seconds on one core.
pub fn geometry(seed: u64) -> GeometryTable {
    let towns = SIZES.iter().flat_map(|&count| [(count, false), (count, true)]);
    let rows = towns.map(|(count, turned)| row(&BenchTown::generate(seed, count, turned))).collect();
    GeometryTable { seed, level: Level::best().name(), rows }
}

/// All contenders.
struct Contenders {
    ours: BoxBvh,
    others: Vec<(&'static str, Box<dyn Contest>)>,
}

fn row(town: &BenchTown) -> GeometryRow {
    let boxes = &town.boxes;
    let contenders = Contenders {
        ours: BoxBvh::build(boxes.clone()),
        others: vec![
            ("parry cast_ray", Box::new(Parry::build(boxes))),
            ("parry traverse", Box::new(ParryWalk(Parry::build(boxes)))),
            ("obvhs Bvh2", Box::new(Obvhs2::build(boxes))),
            ("obvhs CwBvh", Box::new(ObvhsCw::build(boxes))),
            (LOOP, Box::new(BruteForce::new(boxes))),
        ],
    };
    let cameras: Vec<DVec3> =
        town.free_views.iter().chain(&town.hidden_views).map(|view| view.camera_in_world).collect();
    GeometryRow {
        boxes: boxes.len(),
        turned: town.is_turned,
        hidden: rays(&contenders, &town.hidden_views),
        free: rays(&contenders, &town.free_views),
        distances: distances(&contenders, &cameras),
        segments: segments(&contenders, boxes, &cameras),
        build_us: builds(town),
    }
}

/// A contender with one call per many queries, so that its code is compiled as one unit.
trait Contest {
    fn hidden_rays(&self, views: &[View]) -> usize;
    fn answers(&self, views: &[View]) -> Vec<bool>;
    fn sum_of_distances(&self, points: &[DVec3]) -> Option<f64>;
}

impl<C: Contender> Contest for C {
    fn hidden_rays(&self, views: &[View]) -> usize {
        let one =
            |view: &View| view.points_in_world.iter().filter(|&&to| self.blocked(view.camera_in_world, to)).count();
        views.iter().map(one).sum()
    }
    fn answers(&self, views: &[View]) -> Vec<bool> {
        let one = |view: &View| view.points_in_world.map(|to| self.blocked(view.camera_in_world, to));
        views.iter().flat_map(one).collect()
    }
    fn sum_of_distances(&self, points: &[DVec3]) -> Option<f64> {
        points.iter().map(|&point| self.distance_m(point)).sum()
    }
}

fn hidden_by_eights(ours: &BoxBvh, views: &[View]) -> usize {
    let one = |view: &View| {
        let mut hidden = [false; RAYS];
        ours.blocked_batch(view.camera_in_world, &view.points_in_world, &mut hidden);
        hidden.iter().filter(|&&one| one).count()
    };
    views.iter().map(one).sum()
}

fn rays(contenders: &Contenders, views: &[View]) -> RayFigures {
    let mut tasks: Vec<Task<'_>> = vec![
        Task::new(OURS, |part| Contest::hidden_rays(&contenders.ours, &views[part])),
        Task::new(OURS_EIGHT, |part| hidden_by_eights(&contenders.ours, &views[part])),
    ];
    for (name, other) in &contenders.others {
        tasks.push(Task::new(name, |part| other.hidden_rays(&views[part])));
    }
    let rates = measure(&mut tasks, views.len(), RAYS);
    let answers = Contest::answers(&contenders.ours, views);
    let checked = CHECKED_VIEWS.min(views.len());
    let mut by_eights = vec![false; RAYS];
    let mut wrong = 0;
    for (index, view) in views.iter().enumerate() {
        contenders.ours.blocked_batch(view.camera_in_world, &view.points_in_world, &mut by_eights);
        wrong += differences(&by_eights, &answers[RAYS * index..RAYS * (index + 1)]);
    }
    let mut disagreements = Vec::new();
    for (name, other) in &contenders.others {
        if *name == LOOP {
            wrong += differences(&other.answers(&views[..checked]), &answers[..RAYS * checked]);
        } else {
            disagreements.push(Figure { name, value: differences(&other.answers(views), &answers) as f64 });
        }
    }
    let hidden = answers.iter().filter(|&&one| one).count();
    RayFigures {
        rays: answers.len(),
        hidden_share: hidden as f64 / answers.len().max(1) as f64,
        rates,
        disagreements,
        wrong,
    }
}

fn differences(a: &[bool], b: &[bool]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

fn distances(contenders: &Contenders, points: &[DVec3]) -> Vec<Figure> {
    let mut tasks =
        vec![Task::new(OURS, |part| Contest::sum_of_distances(&contenders.ours, &points[part]).is_some() as usize)];
    for (name, other) in &contenders.others {
        if other.sum_of_distances(&points[..1.min(points.len())]).is_some() {
            tasks.push(Task::new(name, |part| {
                black_box(other.sum_of_distances(&points[part]));
                0
            }));
        }
    }
    measure(&mut tasks, points.len(), 1)
}

fn segments(contenders: &Contenders, boxes: &[cosfly_domain::OrientedBox], points: &[DVec3]) -> Vec<Figure> {
    const CAP_M: f64 = 5.0;
    let plain = BruteForce::new(boxes);
    let sum = |query: &dyn SpatialQuery, part: std::ops::Range<usize>| {
        let ends = |&from: &DVec3| query.segment_clearance(from, from + DVec3::new(1.2, -1.5, 0.4), CAP_M);
        black_box(points[part].iter().map(ends).sum::<f64>());
        0
    };
    let mut tasks =
        vec![Task::new(OURS, |part| sum(&contenders.ours, part)), Task::new(LOOP, |part| sum(&plain, part))];
    measure(&mut tasks, points.len(), 1)
}

fn builds(town: &BenchTown) -> Vec<Figure> {
    let boxes = &town.boxes;
    let micros = |build: &dyn Fn()| {
        let rounds = if boxes.len() > 10_000 { 1 } else { ROUNDS };
        median((0..rounds).map(|_| 1e6 * timed(build).1).collect())
    };
    let ours = || _ = black_box(BoxBvh::build(boxes.clone()));
    let parry = || _ = black_box(Parry::build(boxes));
    let obvhs2 = || _ = black_box(Obvhs2::build(boxes));
    let obvhs_cw = || _ = black_box(ObvhsCw::build(boxes));
    let all: [(&str, &dyn Fn()); 4] =
        [(OURS, &ours), ("parry", &parry), ("obvhs Bvh2", &obvhs2), ("obvhs CwBvh", &obvhs_cw)];
    all.into_iter().map(|(name, build)| Figure { name, value: micros(build) }).collect()
}

/// A query to time on a part of the inputs.
struct Task<'a> {
    name: &'static str,
    run: Box<dyn Fn(std::ops::Range<usize>) -> usize + 'a>,
    /// Answers, millions per second, round by round.
    rates: Vec<f64>,
}

impl<'a> Task<'a> {
    fn new(name: &'static str, run: impl Fn(std::ops::Range<usize>) -> usize + 'a) -> Self {
        Self { name, run: Box::new(run), rates: Vec::new() }
    }
}

/// Median rates in millions of answers per second; `count` queries of `answers` each. Slow contenders get fewer
/// queries.
fn measure(tasks: &mut [Task<'_>], count: usize, answers: usize) -> Vec<Figure> {
    let mut parts: Vec<usize> = Vec::new();
    for task in tasks.iter() {
        let few = count.min(4);
        let (_, seconds) = timed(|| black_box((task.run)(0..few)));
        let affordable = few as f64 * SLICE_S / seconds.max(1e-9);
        parts.push((affordable as usize).clamp(few, count));
    }
    for _ in 0..ROUNDS {
        for (task, &part) in tasks.iter_mut().zip(&parts) {
            let begin = thread_cpu_s();
            let (mut answered, mut seconds) = (0, 0.0);
            while seconds < SLICE_S && count > 0 {
                black_box((task.run)(0..part));
                answered += part * answers;
                seconds = thread_cpu_s() - begin;
            }
            task.rates.push(1e-6 * answered as f64 / seconds.max(1e-9));
        }
    }
    tasks.iter().map(|task| Figure { name: task.name, value: median(task.rates.clone()) }).collect()
}

/// Largest figure of a contender other than cosfly.
fn best_other(figures: &[Figure]) -> f64 {
    figures.iter().filter(|f| !f.name.starts_with(OURS)).map(|f| f.value).fold(0.0, f64::max)
}

fn value(figures: &[Figure], name: &str) -> Option<f64> {
    figures.iter().find(|f| f.name == name).map(|f| f.value)
}

impl fmt::Display for GeometryTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "millions per second on one core, {} instructions, seed {}; medians of thread CPU time",
            self.level, self.seed
        )?;
        for row in &self.rows {
            let turned = if row.turned { "turned" } else { "axis-aligned" };
            writeln!(f, "\n{} boxes, {turned}", row.boxes)?;
            writeln!(
                f,
                "  {:<16}{:>12}{:>12}{:>12}{:>12}{:>12}{:>13}",
                "", "rays hidden", "rays free", "distances", "segments", "build us", "disagree"
            )?;
            let names = row.hidden.rates.iter().map(|figure| figure.name);
            for name in names {
                write!(f, "  {name:<16}")?;
                let build = name.split(' ').next().filter(|&n| n == "parry").unwrap_or(name);
                for figures in [&row.hidden.rates, &row.free.rates, &row.distances, &row.segments, &row.build_us] {
                    let name = if std::ptr::eq(figures, &row.build_us) { build } else { name };
                    match value(figures, name) {
                        Some(value) => write!(f, "{value:>12.2}")?,
                        None => write!(f, "{:>12}", "-")?,
                    }
                }
                let of = |figures: &RayFigures| value(&figures.disagreements, name);
                match (of(&row.hidden), of(&row.free)) {
                    (Some(a), Some(b)) => writeln!(f, "{:>7} of {}", a + b, row.hidden.rays + row.free.rays)?,
                    _ => writeln!(f, "{:>13}", "-")?,
                }
            }
            let factor = |figures: &[Figure], ours: &str| {
                let other = best_other(figures);
                value(figures, ours).map_or(0.0, |v| if other > 0.0 { v / other } else { 0.0 })
            };
            writeln!(
                f,
                "  ours by the best other: single rays {:.2} and {:.2}, eight rays {:.2} and {:.2}, distances {:.2}; \
                 {:.0} % and {:.0} % of rays hidden, {} wrong",
                factor(&row.hidden.rates, OURS),
                factor(&row.free.rates, OURS),
                factor(&row.hidden.rates, OURS_EIGHT),
                factor(&row.free.rates, OURS_EIGHT),
                factor(&row.distances, OURS),
                100.0 * row.hidden.hidden_share,
                100.0 * row.free.hidden_share,
                row.hidden.wrong + row.free.wrong,
            )?;
        }
        Ok(())
    }
}

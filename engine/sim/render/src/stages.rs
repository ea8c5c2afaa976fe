//! Durations of the stages of a frame, by a clock that the caller brings.

/// Nanoseconds (or whatever the clock counts) spent in each stage of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stages([u64; Stages::NAMES.len()]);

impl Stages {
    /// The stages in order: boxes and figure drawn, ground drawn, shadow maps, depth and ids and shading (band by band),
    /// the target measured, edges, rain and optics.
    pub const NAMES: [&'static str; 7] = ["boxes", "ground", "shadows", "shading", "target", "smoothing", "overlay"];

    /// Duration of each, in the order of the names.
    pub fn ns(&self) -> [u64; Stages::NAMES.len()] {
        self.0
    }
}

/// Splits time between stages.
pub(crate) struct Stopwatch<'a> {
    now: Option<&'a dyn Fn() -> u64>,
    last: u64,
    stages: Stages,
}

impl<'a> Stopwatch<'a> {
    pub fn new(now: Option<&'a dyn Fn() -> u64>) -> Self {
        Self { now, last: now.map_or(0, |now| now()), stages: Stages::default() }
    }

    /// Ends stage number `stage`.
    pub fn lap(&mut self, stage: usize) {
        if let Some(now) = self.now {
            let time = now();
            self.stages.0[stage] = self.stages.0[stage].wrapping_add(time.wrapping_sub(self.last));
            self.last = time;
        }
    }

    pub fn stages(&self) -> Stages {
        self.stages
    }
}

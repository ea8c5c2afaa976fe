//! A small network: two hidden layers, trained by Adam on the processor.
//!
//! Written out here because frameworks cost minutes of building (candle 4, measured) for two hundred lines, and their
//! kernels round differently from processor to processor; this one gives the same weights everywhere.

use super::features::{PER_WAYPOINT, Scaling, relative, waypoints_of};
use super::{Prediction, View};
use cosfly_frames::{Pose, RandomStream, Seed, real};
use serde::Serialize;

/// Parts of a window that a network is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// Poses of the input frames relative to the current one, its pitch and roll.
    pub poses: bool,
    /// The target's box in every input frame, and whether there is one.
    pub boxes: bool,
}

/// How a network is trained.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Training {
    /// Units of both hidden layers.
    pub hidden: usize,
    /// Steps of Adam.
    pub steps: usize,
    /// Windows per step.
    pub batch: usize,
    /// Step length at first; it falls to nothing along half a cosine.
    pub rate: f32,
    /// Seed of weights and order.
    pub seed: u64,
}

impl Default for Training {
    fn default() -> Self {
        Self { hidden: 64, steps: 4000, batch: 64, rate: 2e-3, seed: 1 }
    }
}

/// A table of windows to learn from; rows are (features, outcomes).
#[derive(Clone, Debug)]
pub struct Lessons {
    inputs: Inputs,
    width: usize,
    depth: usize,
    features: Vec<f64>,
    outcomes: Vec<f64>,
}

/// What a network sees of a window.
fn features_of(inputs: Inputs, view: &View<'_>) -> Vec<f64> {
    let (current, mut features) = (view.current(), vec![]);
    if inputs.poses {
        for pose in &view.poses[..view.poses.len().saturating_sub(1)] {
            features.extend(relative(&current, pose));
        }
        features.extend([current.pitch_rad, current.roll_rad]);
    }
    if inputs.boxes {
        let [width, height] = view.image_px.map(|size| f64::from(size).max(1.0));
        for edges in view.boxes {
            let [left, top, right, bottom] = edges.unwrap_or_default().map(f64::from);
            let middle = [(left + right) / (2.0 * width) - 0.5, (top + bottom) / (2.0 * height) - 0.5];
            let size = [(right - left) / width, (bottom - top) / height];
            match edges {
                Some(_) => features.extend([1.0, middle[0], middle[1], size[0], size[1]]),
                None => features.extend([0.0; 5]),
            }
        }
    }
    features
}

impl Lessons {
    /// No window yet.
    pub fn new(inputs: Inputs) -> Self {
        Self { inputs, width: 0, depth: 0, features: vec![], outcomes: vec![] }
    }

    /// Adds a window with its true waypoints, learnt relative to `start` along the axes of the view's current yaw
    /// (as [`super::features::Examples::push`] does). Windows of another shape than the first are left out.
    pub fn push(&mut self, view: &View<'_>, start: &Pose, truth: &[Pose]) {
        let features = features_of(self.inputs, view);
        if self.features.is_empty() {
            (self.width, self.depth) = (features.len(), truth.len() * PER_WAYPOINT);
        }
        if (features.len(), truth.len() * PER_WAYPOINT) != (self.width, self.depth) {
            return;
        }
        self.features.extend(features);
        for pose in truth {
            self.outcomes.extend(super::features::outcome(view, start, pose));
        }
    }

    /// Number of windows.
    pub fn len(&self) -> usize {
        self.features.len().checked_div(self.width).unwrap_or(0)
    }

    /// Whether there is no window.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Weights of one layer: row per input, the last row is the constant.
#[derive(Clone, Debug, PartialEq)]
struct Layer {
    inputs: usize,
    outputs: usize,
    weights: Vec<f32>,
    /// Adam's running means of gradients and of their squares.
    means: Vec<f32>,
    squares: Vec<f32>,
}

impl Layer {
    fn new(inputs: usize, outputs: usize, gain: f64, stream: &mut RandomStream) -> Self {
        let deviation = gain / (inputs.max(1) as f64).sqrt();
        let mut weights: Vec<f32> = (0..inputs * outputs).map(|_| stream.normal(0.0, deviation) as f32).collect();
        weights.resize((inputs + 1) * outputs, 0.0);
        let count = weights.len();
        Self { inputs, outputs, weights, means: vec![0.0; count], squares: vec![0.0; count] }
    }

    fn forward(&self, given: &[f32], made: &mut [f32]) {
        made.copy_from_slice(&self.weights[self.inputs * self.outputs..]);
        for (value, row) in given.iter().zip(self.weights.chunks_exact(self.outputs)) {
            if *value != 0.0 {
                made.iter_mut().zip(row).for_each(|(sum, weight)| *sum += value * weight);
            }
        }
    }

    /// Adds to `gradient` what `given` and the slope of the loss by this layer's output say, and tells the slope by
    /// its input.
    fn backward(&self, given: &[f32], slope: &[f32], gradient: &mut [f32], input_slope: &mut [f32]) {
        for (at, value) in given.iter().enumerate() {
            let row = at * self.outputs..(at + 1) * self.outputs;
            if *value != 0.0 {
                gradient[row.clone()].iter_mut().zip(slope).for_each(|(sum, slope)| *sum += value * slope);
            }
            input_slope[at] = dot(&self.weights[row], slope);
        }
        let constant = &mut gradient[self.inputs * self.outputs..];
        constant.iter_mut().zip(slope).for_each(|(sum, slope)| *sum += slope);
    }

    /// One step of Adam (Kingma and Ba 2015, their constants); `corrections` are 1 - beta^t of both means.
    fn step(&mut self, gradient: &[f32], rate: f32, corrections: [f32; 2]) {
        let state = self.means.iter_mut().zip(&mut self.squares);
        for ((weight, gradient), (mean, square)) in self.weights.iter_mut().zip(gradient).zip(state) {
            *mean = 0.9 * *mean + 0.1 * gradient;
            *square = 0.999 * *square + 0.001 * gradient * gradient;
            *weight -= rate * (*mean / corrections[0]) / ((*square / corrections[1]).sqrt() + 1e-8);
        }
    }
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [0.0_f32; 8];
    for (a, b) in a.iter().zip(b) {
        (0..8).for_each(|lane| sums[lane] += a[lane] * b[lane]);
    }
    sums.iter().sum::<f32>() + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f32>()
}

/// A trained network.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    inputs: Inputs,
    scaling: Scaling,
    width: usize,
    /// Means and deviations of the outcomes.
    outcome_means: Vec<f64>,
    outcome_spreads: Vec<f64>,
    layers: [Layer; 3],
}

impl Network {
    /// Trains a network on `lessons`: the loss is the mean Huber loss of outcomes scaled to spread one (quadratic
    /// below 1). `None` without lessons.
    pub fn train(lessons: &Lessons, training: &Training) -> Option<Self> {
        let (width, depth, hidden) = (lessons.width, lessons.depth, training.hidden);
        if lessons.is_empty() || depth == 0 || hidden == 0 || training.batch == 0 {
            return None;
        }
        let seed = Seed::of_item(training.seed, "evaluation", "network");
        let mut stream = seed.stream("weights");
        let mut layer = |inputs, outputs, gain| Layer::new(inputs, outputs, gain, &mut stream);
        let (outcome_means, outcome_spreads) = moments(&lessons.outcomes, depth);
        let mut network = Self {
            inputs: lessons.inputs,
            scaling: Scaling::of(&lessons.features, width),
            width,
            outcome_means,
            outcome_spreads,
            layers: [layer(width, hidden, 1.4), layer(hidden, hidden, 1.4), layer(hidden, depth, 0.1)],
        };
        network.learn(lessons, training, &mut seed.stream("order"));
        Some(network)
    }

    fn learn(&mut self, lessons: &Lessons, training: &Training, order: &mut RandomStream) {
        let mut features = lessons.features.clone();
        features.chunks_exact_mut(self.width).for_each(|row| self.scaling.apply(row));
        let features: Vec<f32> = features.into_iter().map(|value| value as f32).collect();
        let depth = lessons.depth;
        let scaled = |row: &[f64]| -> Vec<f32> {
            let scale = self.outcome_means.iter().zip(&self.outcome_spreads);
            row.iter().zip(scale).map(|(value, (mean, spread))| ((value - mean) / spread) as f32).collect()
        };
        let outcomes: Vec<f32> = lessons.outcomes.chunks_exact(depth).flat_map(scaled).collect();
        let mut gradients: [Vec<f32>; 3] = core::array::from_fn(|k| vec![0.0; self.layers[k].weights.len()]);
        let mut pass = Pass::new(&self.layers);
        let mut beta_powers = [1.0_f32; 2];
        for step in 0..training.steps {
            gradients.iter_mut().for_each(|gradient| gradient.fill(0.0));
            for _ in 0..training.batch {
                let row = order.index(lessons.len());
                pass.forward(&self.layers, &features[row * self.width..][..self.width]);
                pass.backward(&self.layers, &outcomes[row * depth..][..depth], training.batch, &mut gradients);
            }
            beta_powers = [beta_powers[0] * 0.9, beta_powers[1] * 0.999];
            let progress = step as f64 / training.steps as f64;
            let rate = training.rate * (0.5 * (1.0 + real::cos(real::PI * progress))) as f32;
            for (layer, gradient) in self.layers.iter_mut().zip(&gradients) {
                layer.step(gradient, rate, beta_powers.map(|power| 1.0 - power));
            }
        }
    }

    /// The waypoints of a window; `None` for one of another shape than those learnt from.
    pub fn predict(&self, view: &View<'_>) -> Option<Prediction> {
        let mut features = features_of(self.inputs, view);
        if features.len() != self.width {
            return None;
        }
        self.scaling.apply(&mut features);
        let features: Vec<f32> = features.into_iter().map(|value| value as f32).collect();
        let mut pass = Pass::new(&self.layers);
        pass.forward(&self.layers, &features);
        let scale = self.outcome_means.iter().zip(&self.outcome_spreads);
        let outcomes: Vec<f64> =
            pass.made[2].iter().zip(scale).map(|(value, (mean, spread))| mean + spread * f64::from(*value)).collect();
        let current = view.current();
        Some(Prediction { current, waypoints: waypoints_of(&current, &outcomes) })
    }
}

/// Means and deviations of columns; a deviation is at least 1e-6, so that it can divide.
fn moments(table: &[f64], width: usize) -> (Vec<f64>, Vec<f64>) {
    let rows = (table.len() / width.max(1)).max(1) as f64;
    let column = |at: usize| table.iter().skip(at).step_by(width.max(1));
    let means: Vec<f64> = (0..width).map(|at| column(at).sum::<f64>() / rows).collect();
    let square = |at: usize| column(at).map(|value| (value - means[at]) * (value - means[at])).sum::<f64>() / rows;
    let spreads = (0..width).map(|at| square(at).sqrt().max(1e-6)).collect();
    (means, spreads)
}

/// Values of one window on its way through the layers, and slopes on the way back.
struct Pass {
    given: Vec<f32>,
    made: [Vec<f32>; 3],
    slopes: [Vec<f32>; 3],
    input_slope: Vec<f32>,
}

impl Pass {
    fn new(layers: &[Layer; 3]) -> Self {
        let outputs = || core::array::from_fn(|k| vec![0.0; layers[k].outputs]);
        Self { given: vec![], made: outputs(), slopes: outputs(), input_slope: vec![0.0; layers[0].inputs] }
    }

    fn forward(&mut self, layers: &[Layer; 3], features: &[f32]) {
        self.given.clear();
        self.given.extend_from_slice(features);
        let [first, second, last] = &mut self.made;
        layers[0].forward(features, first);
        first.iter_mut().for_each(|value| *value = value.max(0.0));
        layers[1].forward(first, second);
        second.iter_mut().for_each(|value| *value = value.max(0.0));
        layers[2].forward(second, last);
    }

    fn backward(&mut self, layers: &[Layer; 3], truth: &[f32], batch: usize, gradients: &mut [Vec<f32>; 3]) {
        let share = 1.0 / (batch * truth.len()) as f32;
        let [first, second, last] = &mut self.slopes;
        for ((slope, made), truth) in last.iter_mut().zip(&self.made[2]).zip(truth) {
            *slope = (made - truth).clamp(-1.0, 1.0) * share;
        }
        layers[2].backward(&self.made[1], last, &mut gradients[2], second);
        second.iter_mut().zip(&self.made[1]).for_each(|(slope, made)| *slope *= f32::from(u8::from(*made > 0.0)));
        layers[1].backward(&self.made[0], second, &mut gradients[1], first);
        first.iter_mut().zip(&self.made[0]).for_each(|(slope, made)| *slope *= f32::from(u8::from(*made > 0.0)));
        layers[0].backward(&self.given, first, &mut gradients[0], &mut self.input_slope);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec3;

    const POSES: Inputs = Inputs { poses: true, boxes: false };

    /// Flights along circles: what comes next is no linear function of what was.
    fn circles(number: u64) -> Vec<Vec<Pose>> {
        let mut stream = Seed::of_item(number, "test", "network").stream("circles");
        let mut circle = || {
            let (speed, turn, start) = (stream.uniform(0.2, 1.5), stream.uniform(-0.3, 0.3), stream.uniform(-3.0, 3.0));
            let mut place = DVec3::new(0.0, 0.0, 25.0);
            let pose = |k: usize| {
                let yaw_rad = start + turn * k as f64;
                place += speed * DVec3::new(real::cos(yaw_rad), real::sin(yaw_rad), 0.0);
                Pose { position_in_world: place, pitch_rad: -0.7, yaw_rad, roll_rad: 0.0 }
            };
            (0..10).map(pose).collect()
        };
        (0..400).map(|_| circle()).collect()
    }

    fn view(poses: &[Pose]) -> View<'_> {
        View { poses: &poses[..5], horizon: 5, ..View::default() }
    }

    #[test]
    fn circles_are_learnt_and_the_same_seed_learns_the_same() {
        let mut lessons = Lessons::new(POSES);
        for poses in circles(1) {
            lessons.push(&view(&poses), &poses[4], &poses[5..]);
        }
        let training = Training { hidden: 32, steps: 600, batch: 16, ..Training::default() };
        let network = Network::train(&lessons, &training).unwrap();
        let fde = |predict: &dyn Fn(&View<'_>) -> Prediction| {
            let errors = circles(2)
                .iter()
                .map(|poses| crate::errors(&predict(&view(poses)).waypoints, &poses[5..]).fde_m)
                .sum::<f64>();
            errors / 400.0
        };
        let (learnt, line) = (
            fde(&|view| network.predict(view).unwrap()),
            fde(&|view| super::super::Extrapolation::ConstantVelocity.predict(view)),
        );
        assert!(learnt < 0.4 * line, "{learnt} {line}");
        assert_eq!(network, Network::train(&lessons, &training).unwrap());
        assert_ne!(network, Network::train(&lessons, &Training { seed: 2, ..training }).unwrap());
    }

    #[test]
    fn gradients_are_those_of_finite_differences() {
        let mut stream = Seed::of_item(3, "test", "gradient").stream("numbers");
        let mut layers = [
            Layer::new(3, 4, 1.0, &mut stream),
            Layer::new(4, 4, 1.0, &mut stream),
            Layer::new(4, 2, 1.0, &mut stream),
        ];
        let (given, truth) = ([0.3, -0.8, 0.5], [0.2, -0.1]);
        let loss = |layers: &[Layer; 3]| {
            let mut pass = Pass::new(layers);
            pass.forward(layers, &given);
            let huber = |d: f64| if d.abs() < 1.0 { 0.5 * d * d } else { d.abs() - 0.5 };
            pass.made[2].iter().zip(truth).map(|(made, truth)| huber(f64::from(*made) - f64::from(truth))).sum::<f64>()
                / 2.0
        };
        let mut gradients: [Vec<f32>; 3] = core::array::from_fn(|k| vec![0.0; layers[k].weights.len()]);
        let mut pass = Pass::new(&layers);
        pass.forward(&layers, &given);
        pass.backward(&layers, &truth, 1, &mut gradients);
        for k in 0..3 {
            for (at, gradient) in gradients[k].iter().enumerate() {
                let kept = layers[k].weights[at];
                let mut shifted = |by: f32| {
                    layers[k].weights[at] = kept + by;
                    let found = loss(&layers);
                    layers[k].weights[at] = kept;
                    found
                };
                let expected = (shifted(1e-3) - shifted(-1e-3)) / 2e-3;
                assert!((f64::from(*gradient) - expected).abs() < 2e-3, "{k} {at} {expected} {gradient}");
            }
        }
    }
}

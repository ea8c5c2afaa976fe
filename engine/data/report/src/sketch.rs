//! A flight as the page shows it: a few numbers per frame. World frame, metres.

use serde::{Deserialize, Serialize};

/// A flight with a few numbers per frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlightSketch {
    /// Place in the order of the tables.
    pub number: u64,
    /// Id.
    pub id: String,
    /// Id of the flight, which several films may show; empty where films are flights.
    pub flight_id: String,
    /// True for a perturbed flight, false for an expert's.
    pub is_perturbed: bool,
    /// Id of the pedestrian.
    pub pedestrian: String,
    /// Name of the town.
    pub town: String,
    /// Name of the weather.
    pub weather: String,
    /// Name of the split.
    pub split: String,
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Width and height of images, pixels.
    pub image_px: [u32; 2],
    /// Positions of the drone.
    pub drone_m: Vec<[f32; 3]>,
    /// Feet of the target.
    pub feet_m: Vec<[f32; 3]>,
    /// Share of the target's body that rays from the camera reach, 0..=1.
    pub visible: Vec<f32>,
    /// Distance to the nearest obstacle.
    pub clearance_m: Vec<f32>,
    /// Edges of the box around the whole body in the image, hidden or not: left, top, right, bottom.
    pub box_px: Vec<Option<[f32; 4]>>,
    /// Whether all limits hold.
    pub holds: bool,
    /// Broken limits as text.
    pub violations: Vec<String>,
    /// Largest jerk, m/s^3.
    pub max_jerk_mps3: f64,
    /// Total cost after each step of planning.
    pub convergence: Vec<f64>,
    /// Weighted cost of each term of the published flight.
    pub term_costs: Vec<(String, f64)>,
    /// Instructions and goals.
    pub texts: Vec<TextSketch>,
}

/// A text about a flight, and what the page counts of it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TextSketch {
    /// Language code.
    pub language: String,
    /// Kind of text, such as `instruction` or `step`.
    pub kind: String,
    /// The text.
    pub text: String,
    /// Subjects that it speaks of.
    pub subjects: Vec<String>,
    /// Whether it names clothes that nobody else who is seen in the flight wears.
    pub singles_out: bool,
    /// Whether a language model wrote it.
    pub is_taught: bool,
    /// Answers of the model that were refused.
    pub refused: u64,
    /// Subjects of the contradictions for which they were refused, one an answer and subject.
    pub refused_for: Vec<String>,
}

impl FlightSketch {
    /// Number of frames.
    pub fn len(&self) -> usize {
        self.drone_m.len()
    }

    /// Whether it has no frame.
    pub fn is_empty(&self) -> bool {
        self.drone_m.is_empty()
    }

    /// Whether all costs of planning are known and can be drawn.
    pub fn is_planned(&self) -> bool {
        self.convergence.len() > 1 && self.convergence.iter().all(|cost| cost.is_finite() && *cost > 0.0)
    }

    /// Time from the first frame to the last, seconds.
    pub fn duration_s(&self) -> f64 {
        self.dt_s * self.len().saturating_sub(1) as f64
    }

    /// Mean visibility; 0 without frames.
    pub fn mean_visible(&self) -> f64 {
        self.visible.iter().map(|share| f64::from(*share)).sum::<f64>() / self.visible.len().max(1) as f64
    }

    /// Distance from the camera to the feet in every frame, metres.
    pub fn distances_m(&self) -> Vec<f32> {
        let pairs = self.drone_m.iter().zip(&self.feet_m);
        pairs.map(|(drone, feet)| length([drone[0] - feet[0], drone[1] - feet[1], drone[2] - feet[2]])).collect()
    }

    /// Speed of the drone between frames, m/s.
    pub fn speeds_mps(&self) -> Vec<f32> {
        speeds(&self.drone_m, self.dt_s)
    }

    /// Speed of the target between frames, m/s.
    pub fn target_speeds_mps(&self) -> Vec<f32> {
        speeds(&self.feet_m, self.dt_s)
    }

    /// Height of the box around the body, pixels; 0 when it is not in the image.
    pub fn box_height_px(&self, frame: usize) -> f32 {
        self.box_px.get(frame).copied().flatten().map_or(0.0, |edges| edges[3] - edges[1])
    }

    /// First frame and number of frames of each stretch in which less than half of the target is visible.
    pub fn occlusions(&self) -> Vec<(usize, usize)> {
        let mut stretches: Vec<(usize, usize)> = vec![];
        for (frame, _) in self.visible.iter().enumerate().filter(|(_, share)| **share < 0.5) {
            match stretches.last_mut() {
                Some((start, count)) if *start + *count == frame => *count += 1,
                _ => stretches.push((frame, 1)),
            }
        }
        stretches
    }
}

fn speeds(places: &[[f32; 3]], dt_s: f64) -> Vec<f32> {
    let step = |pair: &[[f32; 3]]| length([0, 1, 2].map(|axis| pair[1][axis] - pair[0][axis])) / dt_s as f32;
    places.windows(2).map(step).collect()
}

fn length(v: [f32; 3]) -> f32 {
    v.iter().map(|it| it * it).sum::<f32>().sqrt()
}

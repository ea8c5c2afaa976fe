//! Predictions and baselines, asked alike for the waypoints of a window.

use crate::join::Joined;
use crate::settings::Settings;
use crate::windows::{Flights, Window, WindowSet};
use cosfly_diagnose::Result;
use cosfly_frames::Pose;
use cosfly_metrics::baselines::features::{Examples, Known};
use cosfly_metrics::baselines::{Anchor, Extrapolation, NearestNeighbour, Ridge};
use cosfly_metrics::waypoints;
use cosfly_read::predictions::Predictions;

/// Windows that baselines learn from at most, evenly spread over the training flights.
const LEARNT_WINDOWS: usize = 200_000;
/// Numbers that the nearest neighbour compares over all windows at most; it remembers fewer windows when there are
/// many to predict.
const COMPARED_NUMBERS: usize = 8_000_000_000;

/// Something that predicts.
pub enum Method<'a> {
    /// Rows of a file of predictions.
    Predictions(&'a Predictions, &'a Joined),
    /// A polynomial or the target's motion.
    Extrapolation(Extrapolation),
    /// Ridge autoregression, from boxes or from the target's true places.
    Ridge(Ridge),
    /// The most similar training window.
    Nearest(NearestNeighbour),
}

impl Method<'_> {
    /// The name in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Predictions(..) => "predictions",
            Self::Extrapolation(Extrapolation::Zero) => "predict zero",
            Self::Extrapolation(Extrapolation::ConstantVelocity) => "constant velocity",
            Self::Extrapolation(Extrapolation::ConstantAcceleration) => "constant acceleration",
            Self::Extrapolation(Extrapolation::CopyTarget) => "copy target",
            Self::Ridge(ridge) if ridge.known() == Known::Boxes => "ridge",
            Self::Ridge(_) => "ridge, true target",
            Self::Nearest(_) => "nearest neighbour",
        }
    }

    /// The waypoints of window number `number`; `None` where there is no prediction.
    pub fn waypoints(
        &self,
        flights: &Flights,
        window: Window,
        number: usize,
        settings: &Settings,
    ) -> Option<Vec<Pose>> {
        let shape = &settings.window;
        if let Self::Predictions(rows, joined) = self {
            let zero = vec![[0.0; 6]; shape.horizon];
            let deltas = match joined.row(number) {
                Some(row) => rows.row(row).deltas,
                None if settings.missing_as_zero => &zero[..],
                None => return None,
            };
            let anchor = flights.anchor(window, shape, settings.anchor);
            let mut reached = Vec::with_capacity(deltas.len());
            waypoints(&anchor, deltas, settings.delta_frame, settings.delta_origin, &mut reached);
            return Some(reached);
        }
        let view = flights.view(window, shape);
        let prediction = match self {
            Self::Extrapolation(method) => method.predict(&view),
            Self::Ridge(ridge) => ridge.predict(&view)?,
            Self::Nearest(memory) => memory.predict(&view)?,
            Self::Predictions(..) => return None,
        };
        Some(match settings.anchor {
            Anchor::Input => prediction.waypoints,
            Anchor::Expert => prediction.started_at(&flights.anchor(window, shape, Anchor::Expert)),
        })
    }

    /// The target's boxes that the method predicts, one per waypoint; empty for none.
    pub fn boxes(
        &self,
        flights: &Flights,
        window: Window,
        number: usize,
        settings: &Settings,
    ) -> Vec<Option<[f64; 4]>> {
        match self {
            Self::Predictions(rows, joined) => {
                joined.row(number).map(|row| rows.row(row).boxes.to_vec()).unwrap_or_default()
            }
            // The last box that was seen stays where it was in the image.
            Self::Extrapolation(Extrapolation::Zero) => {
                let seen = flights.view(window, &settings.window).boxes.iter().rev().find_map(|edges| *edges);
                vec![seen.map(|edges| edges.map(f64::from)); settings.window.horizon]
            }
            _ => vec![],
        }
    }
}

/// Windows of split `train` that baselines learn from.
fn training_windows(flights: &Flights, settings: &Settings) -> Vec<Window> {
    let set = WindowSet::new(flights, settings, &["train".to_owned()].into());
    let every = set.len.div_ceil(LEARNT_WINDOWS).max(1);
    set.all(flights).step_by(every).collect()
}

/// Training windows as features and outcomes: with the target's true places, and with its boxes.
fn examples(flights: &Flights, settings: &Settings) -> Result<[Examples; 2]> {
    let shape = &settings.window;
    let mut examples = [Known::Places, Known::Boxes].map(|known| Examples { known, ..Examples::default() });
    let windows = training_windows(flights, settings);
    for part in flights.parts(&windows, &|window| window.flight) {
        let mut chosen: Vec<usize> = part.iter().map(|window| window.flight).collect();
        chosen.dedup();
        let loaded = flights.part(&chosen)?;
        for window in part {
            let start = loaded.anchor(*window, shape, settings.anchor);
            let (view, truth) = (loaded.view(*window, shape), loaded.truth(*window, shape));
            examples.iter_mut().for_each(|examples| examples.push(&view, &start, &truth));
        }
    }
    Ok(examples)
}

/// All baselines that can be made; the reasons why others cannot go to `notes`.
///
/// # Errors
/// Damage of the dataset.
pub fn baselines(
    flights: &Flights,
    settings: &Settings,
    windows: usize,
    in_sample: bool,
    notes: &mut Vec<String>,
) -> Result<Vec<Method<'static>>> {
    let mut methods: Vec<Method<'static>> = Extrapolation::ALL.map(Method::Extrapolation).into();
    let [examples, with_boxes] = examples(flights, settings)?;
    if examples.is_empty() {
        notes.push("ridge and nearest neighbour are left out: split train has no window to learn from".to_owned());
        return Ok(methods);
    }
    if in_sample {
        notes
            .push("ridge and nearest neighbour have learnt from windows that are scored here (split train)".to_owned());
    }
    let limit = COMPARED_NUMBERS / windows.max(1) / examples.width.max(1);
    methods.extend(Ridge::fit(&with_boxes).map(Method::Ridge));
    methods.extend(Ridge::fit(&examples).map(Method::Ridge));
    methods.extend(NearestNeighbour::fit(&examples, limit.max(64)).map(Method::Nearest));
    Ok(methods)
}

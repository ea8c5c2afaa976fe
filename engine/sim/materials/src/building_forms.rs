//! Tells the form of each building from its plan, height and roof.

use crate::building_form::BuildingForm;
use crate::parts::SceneBox;
use crate::roof_steps::{ends_m, half_m};
use cosfly_domain::ObstacleKind;
use cosfly_frames::{DVec2, real};
use std::collections::BTreeMap;

/// Directions along which a plan is measured, over half a turn.
const DIRECTIONS: usize = 8;
/// A plan is round where it is as wide in all directions, but for this share.
const ROUND: f64 = 0.94;
/// Widths of tanks, and their greatest height, metres.
const TANK_M: [f64; 2] = [5.0, 40.0];
const HIGHEST_TANK_M: f64 = 20.0;
/// The least depth of halls, and their greatest height with the roof, metres.
const HALL_M: f64 = 16.0;
const HIGHEST_HALL_M: f64 = 12.5;
/// The greatest depth and height of homes, metres: two storeys and a roof.
const HOME_M: f64 = 15.0;
const HIGHEST_HOME_M: f64 = 10.5;

/// The plan of a building, and its height.
struct Plan {
    /// Both ends along each direction.
    ends_m: [[f64; 2]; DIRECTIONS],
    foot_m: f64,
    top_m: f64,
    /// The shorter side of its largest box.
    deep_m: f64,
    is_pitched: bool,
}

impl Plan {
    const NONE: Self = Self {
        ends_m: [[f64::INFINITY, f64::NEG_INFINITY]; DIRECTIONS],
        foot_m: f64::INFINITY,
        top_m: f64::NEG_INFINITY,
        deep_m: 0.0,
        is_pitched: false,
    };

    fn add(&mut self, b: &SceneBox, directions: &[DVec2; DIRECTIONS]) {
        let (middle, half) = (b.center_in_world.truncate(), half_m(b));
        let [u, v] = b.axes_in_world.map(|axis| axis.truncate());
        for ([low, high], direction) in self.ends_m.iter_mut().zip(directions) {
            let (at, reach) =
                (middle.dot(*direction), half.x * direction.dot(u).abs() + half.y * direction.dot(v).abs());
            (*low, *high) = (low.min(at - reach), high.max(at + reach));
        }
        let [foot_m, top_m] = ends_m(b);
        (self.foot_m, self.top_m) = (self.foot_m.min(foot_m), self.top_m.max(top_m));
        self.deep_m = self.deep_m.max(2.0 * half.min_element());
        self.is_pitched |= b.roof.is_some();
    }

    fn form(&self) -> BuildingForm {
        let height_m = self.top_m - self.foot_m;
        let widths = self.ends_m.map(|[low, high]| high - low);
        let narrowest_m = widths.into_iter().fold(f64::INFINITY, f64::min);
        let widest_m = widths.into_iter().fold(0.0, f64::max);
        let is_round = narrowest_m > ROUND * widest_m && (TANK_M[0]..TANK_M[1]).contains(&widest_m);
        if is_round && !self.is_pitched && height_m < HIGHEST_TANK_M.min(1.5 * widest_m) {
            BuildingForm::Tank
        } else if self.deep_m > HALL_M && height_m < HIGHEST_HALL_M {
            BuildingForm::Hall
        } else if self.deep_m < HOME_M && height_m < HIGHEST_HOME_M {
            BuildingForm::Home
        } else if self.is_pitched {
            BuildingForm::Roofed
        } else {
            BuildingForm::Block
        }
    }
}

/// Tells the boxes of each building its form; their places in roofs are known.
pub fn tell_forms(boxes: &mut [SceneBox]) {
    let directions: [DVec2; DIRECTIONS] = core::array::from_fn(|k| {
        let (sin, cos) = real::sin_cos(real::PI * k as f64 / DIRECTIONS as f64);
        DVec2::new(cos, sin)
    });
    let mut plans: BTreeMap<u32, Plan> = BTreeMap::new();
    for b in boxes.iter().filter(|b| b.kind == ObstacleKind::Building) {
        plans.entry(b.instance).or_insert(Plan::NONE).add(b, &directions);
    }
    for b in boxes.iter_mut().filter(|b| b.kind == ObstacleKind::Building) {
        b.form = plans.get(&b.instance).map_or(BuildingForm::Block, Plan::form);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::boxes_of;
    use crate::roof_steps::roof_steps;
    use cosfly_domain::{Obstacle, Town};
    use cosfly_town::solids::{Footprint, Roof, building_boxes};

    fn form(outer: &[(f64, f64)], height_m: f64, roof: Roof) -> BuildingForm {
        let outer = outer.iter().map(|(x, y)| DVec2::from_angle(0.3).rotate(DVec2::new(*x, *y))).collect();
        let shapes = building_boxes(&Footprint { outer, holes: vec![] }, 0.0, height_m, roof).boxes;
        let obstacle = |shape| Obstacle { shape, kind: ObstacleKind::Building, object_id: 1, synthetic: false };
        let town = Town { obstacles: shapes.into_iter().map(obstacle).collect(), ..Town::default() };
        let mut boxes = boxes_of(&town, 1);
        let steps = roof_steps(&boxes);
        boxes.iter_mut().zip(steps).for_each(|(b, step)| b.roof = step.map(Box::new));
        tell_forms(&mut boxes);
        assert!(boxes.iter().all(|b| b.form == boxes[0].form));
        boxes[0].form
    }

    #[test]
    fn forms_follow_from_plan_height_and_roof() {
        let plan = |x: f64, y: f64| [(0.0, 0.0), (x, 0.0), (x, y), (0.0, y)];
        let gabled = Roof::Gabled { rise_m: 3.0, ridge_yaw_rad: None };
        assert_eq!(form(&plan(12.0, 9.0), 6.0, gabled), BuildingForm::Home);
        assert_eq!(form(&plan(12.0, 9.0), 6.0, Roof::Flat), BuildingForm::Home);
        assert_eq!(form(&plan(12.0, 9.0), 12.0, gabled), BuildingForm::Roofed);
        assert_eq!(form(&plan(60.0, 30.0), 9.0, Roof::Flat), BuildingForm::Hall);
        assert_eq!(form(&plan(12.0, 12.0), 12.0, Roof::Flat), BuildingForm::Block);
        assert_eq!(form(&plan(60.0, 30.0), 24.0, Roof::Flat), BuildingForm::Block);
        let round: Vec<(f64, f64)> = (0..14)
            .map(|k| real::sin_cos(real::TAU * f64::from(k) / 14.0))
            .map(|(sin, cos)| (8.0 * cos, 8.0 * sin))
            .collect();
        assert_eq!(form(&round, 11.0, Roof::Flat), BuildingForm::Tank);
        assert_eq!(form(&round, 40.0, Roof::Flat), BuildingForm::Block);
    }
}

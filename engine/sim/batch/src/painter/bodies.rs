//! Whoever moves in a picture: people as frustums, vehicles as triangles.

use super::Painter;
use crate::canvas::WIDE;
use crate::eye::{Eye, NEAR_M};
use crate::faces::{BODY, DrawnFace, SKY};
use crate::figures::{Around, SeenPart, Stance};
use crate::view::BatchView;
use cosfly_domain::{SemanticLabel, TARGET_INSTANCE};
use cosfly_figures::{BodyFigure, Region, add_figure};
use cosfly_frames::DVec3;
use cosfly_raster::visibility::NO_FACE;
use cosfly_render::{BodyPart, LEAST_HEIGHT_PX};

impl Painter {
    pub(super) fn draw_people(&mut self, eye: &Eye, view: &BatchView<'_>) {
        if let Some(target) = view.target.as_ref().filter(|target| target.has_body()) {
            self.draw_figure(eye, target, (0, TARGET_INSTANCE));
        }
        for (who, other) in (1..).zip(view.others).filter(|(_, other)| other.figure.has_body()) {
            self.draw_figure(eye, &other.figure, (who, other.instance));
        }
    }

    /// Whether something covers a pixel centre and is not hidden.
    fn may_show(&self, around: &Around) -> bool {
        let part = self.canvas.part(around.low, around.high);
        let nearest = (1.0 / around.nearest_m.max(NEAR_M)) as f32;
        part.is_some_and(|part| !self.hidden.hides(&self.canvas, part, nearest))
    }

    /// Draws somebody: `who` is 0 for the target, else one more than the place among the others.
    fn draw_figure(&mut self, eye: &Eye, figure: &BodyFigure, (who, instance): (u32, u32)) {
        let (low, high) = figure.bounds_in_world();
        if eye.see(0.5 * (low + high)).x < -(high - low).max_element() {
            return;
        }
        let away_m = (eye.position_in_world - eye.position_in_world.clamp(low, high)).length();
        if instance != TARGET_INSTANCE
            && eye.focal_px * figure.body.height_m(figure.height_m) < LEAST_HEIGHT_PX * away_m
        {
            return;
        }
        if !self.may_show(&Around::of_box(eye, low, high)) {
            return;
        }
        if !figure.body.is_person() {
            self.draw_vehicle(eye, figure, (who, instance));
            return;
        }
        let mut parts = self.body.take().unwrap_or_default();
        parts.set(figure, self.wardrobe.clothes(&figure.clothes_seed));
        let stance = Stance::new(eye, figure, parts.lowest());
        let face = DrawnFace { instance, label: SemanticLabel::Pedestrian.id(), ..SKY };
        let mut seen = SeenPart::default();
        for eight in parts.all().chunks(WIDE) {
            let found = stance.parts(self.level, eight);
            for (_, part) in eight.iter().enumerate().filter(|(k, _)| found.get(*k).is_some()) {
                let number = self.body_part(who, part.region, || stance.middle_in_world(part));
                stance.see(self.level, part, &mut seen);
                self.draw_body_part(eye, &seen, DrawnFace { number, ..face });
            }
        }
        self.body = Some(parts);
    }

    /// A vehicle with its rider, as in large pictures.
    fn draw_vehicle(&mut self, eye: &Eye, figure: &BodyFigure, (who, instance): (u32, u32)) {
        let mut triangles = core::mem::take(&mut self.vehicle);
        triangles.clear();
        add_figure(figure, self.wardrobe.clothes(&figure.clothes_seed), 0, &mut triangles);
        // Parts of the vehicle, whose faces come in any order, and the last part of a rider.
        let mut numbers = [None; Region::COUNT];
        let mut last = (u32::MAX, NO_FACE);
        for (at, triangle) in (0..).zip(&triangles) {
            let is_rider = triangle.region.is_of_people();
            let known =
                if is_rider { (last.0 == triangle.part).then_some(last.1) } else { numbers[triangle.region as usize] };
            let number = known.unwrap_or_else(|| self.body_part(who, triangle.region, || triangle.middle_in_world));
            if is_rider {
                last = (triangle.part, number);
            } else {
                numbers[triangle.region as usize] = Some(number);
            }
            let label = figure.body.label(triangle.region).id();
            let face = DrawnFace { instance, label, number, triangle: at, ..SKY };
            self.draw_triangle(eye, &triangle.corners_in_world, face);
        }
        self.vehicle = triangles;
    }

    /// Notes a part of a body, where colours need it; its number for faces.
    fn body_part(&mut self, who: u32, region: Region, middle_in_world: impl FnOnce() -> [DVec3; 2]) -> u32 {
        if !self.has_colours {
            return NO_FACE;
        }
        self.parts.push(BodyPart { who, region, middle_in_world: middle_in_world() });
        BODY + (self.parts.len() as u32 - 1)
    }

    /// A closed frustum: its sides as two triangles each, its ends.
    fn draw_body_part(&mut self, eye: &Eye, seen: &SeenPart, face: DrawnFace) {
        if seen.nearest_m < NEAR_M as f32 {
            for corners in seen.triangles() {
                self.draw_seen_triangle(eye, &corners, face);
            }
            return;
        }
        let Some(part) = self.canvas.part(seen.low, seen.high) else { return };
        if self.hidden.hides(&self.canvas, part, 1.0 / seen.nearest_m) {
            return;
        }
        for (part, corners, points) in seen.sides() {
            if let Some(plane) = super::plane_through(eye, &corners) {
                self.draw_part(part, &points, DrawnFace { plane, ..face }, 0.0);
            }
        }
        for (corners, points) in seen.ends() {
            if let Some(plane) = super::plane_through(eye, &corners) {
                self.draw_points(&points, DrawnFace { plane, ..face }, 0.0);
            }
        }
    }
}

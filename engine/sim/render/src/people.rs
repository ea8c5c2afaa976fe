//! The people of a frame: who of them can be seen, or throws a shadow that can, and their figures.

use crate::found::BodyPart;
use crate::outlook::FarLight;
use crate::setup::FrameSetup;
use crate::shade::headlights;
use cosfly_domain::TARGET_INSTANCE;
use cosfly_figures::clothes::Region;
use cosfly_figures::figure::{FigureTriangle, figure};
use cosfly_figures::{BodyShape, Clothes, Livery, Walker, Wardrobe};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_materials::vector::Vec3;
use cosfly_raster::eye::Eye;
use cosfly_raster::nearer::Nearer;
use cosfly_raster::visibility::{NEAR_M, Screen};
use std::ops::Range;

/// Shadows are looked for on ground that lies at most this far below the feet, metres.
const DROP_M: f64 = 8.0;
/// Shading looks this far around a point, metres.
const MARGIN_M: f64 = 0.5;
/// People whose bodies are less high than this are left out, pixels.
pub const LEAST_HEIGHT_PX: f64 = 1.0;

/// Somebody whose figure is built in this frame.
pub(crate) struct Person {
    pub walker: Walker,
    pub clothes: Clothes,
    /// Linear RGB, indexed by [`Region`].
    pub colours: [[f32; 3]; Region::COUNT],
    /// To the right of the body, unit length.
    pub side_in_world: Vec3,
    pub instance: u32,
    /// Triangles of the figure among those of all, where they are needed.
    pub triangles: Range<usize>,
    /// Whether the body itself may be seen.
    pub is_seen: bool,
    /// Part of the screen where the body, its shadow and the light of its lamps may be seen.
    pub reach: Reach,
    /// Height of the body, pixels.
    pub height_px: f64,
}

/// A part of the screen: left, top, right and bottom edge, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reach(pub [f64; 4]);

impl Reach {
    const EVERYWHERE: Self = Self([f64::NEG_INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY]);
    const NOWHERE: Self = Self([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY]);

    /// Around points in body axes; everywhere, when one is not ahead of the camera.
    fn around(screen: &Screen, points: impl Iterator<Item = DVec3>) -> Self {
        let mut edges = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for point in points {
            if point.x < NEAR_M || !point.is_finite() {
                return Self::EVERYWHERE;
            }
            let scale = screen.focal_px / point.x;
            let (u, v) = (screen.center_u + point.y * scale, screen.center_v - point.z * scale);
            edges = [edges[0].min(u), edges[1].min(v), edges[2].max(u), edges[3].max(v)];
        }
        Self(edges)
    }

    /// First column and row of pixels that it holds any part of, and the ones past the last.
    pub fn pixels(&self) -> [i32; 4] {
        let [left, top, right, bottom] = self.0;
        [left.floor() as i32, top.floor() as i32, right.ceil() as i32, bottom.ceil() as i32]
    }

    /// Whether it holds a pixel of these rows.
    pub fn meets_rows(&self, rows: Range<usize>) -> bool {
        self.0[1] < rows.end as f64 && self.0[3] > rows.start as f64
    }
}

/// What a part of somebody's figure looks like.
#[derive(Clone, Copy)]
pub(crate) struct PartLook {
    /// Index among the members.
    pub person: u32,
    pub region: Region,
    /// The ends of its middle line.
    pub middle_in_world: [DVec3; 2],
}

/// Everybody in a frame; the target comes first, if there is one.
#[derive(Default)]
pub(crate) struct People {
    pub members: Vec<Person>,
    pub triangles: Vec<FigureTriangle>,
    /// Parts of figures that were drawn.
    pub looks: Vec<PartLook>,
    wardrobe: Wardrobe,
    /// Of the target and everybody else: whether they were found, and then their numbers among the members.
    found: Vec<Option<u32>>,
}

/// What triangles of a figure are built for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Built {
    ForPicture,
    /// Those of people are not: their shadows are drawn from the parts of their figures.
    ForShadow,
    Never,
}

impl People {
    /// Takes over a frame's target: always, wherever it is.
    pub fn begin(&mut self, setup: &FrameSetup<'_>, eye: &Eye, screen: &Screen, far: FarLight) {
        self.members.clear();
        self.triangles.clear();
        self.looks.clear();
        if let Some(target) = setup.target.as_ref().map(|target| target.walker()).filter(Walker::has_body) {
            let body = Bounds::new(&target);
            let height_px = body.height_px(&target, eye, screen);
            self.add(target, TARGET_INSTANCE, true, body.reach(eye, screen, far), height_px, Built::ForPicture);
        }
    }

    /// Adds everybody else who may matter to the picture; `drawn` is what may hide them.
    pub fn gather(&mut self, setup: &FrameSetup<'_>, eye: &Eye, screen: &Screen, far: FarLight, drawn: &Nearer) {
        for other in setup.others.iter().filter(|other| other.walker.has_body()) {
            let body = Bounds::new(&other.walker);
            let may_matter = body.may_matter(&other.walker, eye, screen, far);
            if !may_matter || body.with_shadow(far).is_hidden(eye, screen, drawn) {
                continue;
            }
            let height_px = body.height_px(&other.walker, eye, screen);
            let is_seen = body.is_in_view(eye, screen) && !body.is_hidden(eye, screen, drawn);
            self.add(other.walker, other.instance, is_seen, body.reach(eye, screen, far), height_px, Built::ForPicture);
        }
    }

    /// Takes over those whose parts were found in a picture; with `drawn`, all who may darken what it shows, too.
    pub fn adopt(
        &mut self,
        setup: &FrameSetup<'_>,
        (eye, screen): (&Eye, &Screen),
        far: FarLight,
        parts: &[BodyPart],
        drawn: Option<&Nearer>,
    ) {
        self.members.clear();
        self.triangles.clear();
        self.looks.clear();
        self.found.clear();
        self.found.resize(setup.others.len() + 1, None);
        for part in parts {
            if let Some(found) = self.found.get_mut(part.who as usize) {
                *found = Some(0);
            }
        }
        let target = setup.target.as_ref().map(|target| (target.walker(), TARGET_INSTANCE));
        let others = setup.others.iter().map(|other| Some((other.walker, other.instance)));
        for (who, body) in core::iter::once(target).chain(others).enumerate() {
            let Some((walker, instance)) = body.filter(|(walker, _)| walker.has_body()) else { continue };
            let (bounds, is_target) = (Bounds::new(&walker), who == 0);
            let darkens = drawn.is_some_and(|drawn| {
                is_target
                    || bounds.may_matter(&walker, eye, screen, far)
                        && !bounds.with_shadow(far).is_hidden(eye, screen, drawn)
            });
            if darkens {
                let height_px = bounds.height_px(&walker, eye, screen);
                let reach = bounds.reach(eye, screen, far);
                self.found[who] = Some(self.members.len() as u32);
                self.add(walker, instance, true, reach, height_px, Built::ForShadow);
            } else if self.found[who].is_some() {
                self.found[who] = Some(self.members.len() as u32);
                self.add(walker, instance, true, Reach::NOWHERE, 0.0, Built::Never);
            }
        }
        let found = &self.found;
        self.looks.extend(parts.iter().map(|part| {
            let person = found.get(part.who as usize).copied().flatten().unwrap_or(0);
            PartLook { person, region: part.region, middle_in_world: part.middle_in_world }
        }));
    }

    fn add(&mut self, walker: Walker, instance: u32, is_seen: bool, reach: Reach, height_px: f64, built: Built) {
        let first = self.triangles.len();
        let clothes = *self.wardrobe.clothes(&walker.clothes_seed);
        let is_person = walker.body.is_person();
        if built == Built::ForPicture || built == Built::ForShadow && !is_person {
            figure(&walker, &clothes, self.members.len() as u32, &mut self.triangles);
        }
        let triangles = first..self.triangles.len();
        let mut colours = match walker.body {
            BodyShape::Person { .. } => [[0.0; 3]; Region::COUNT],
            BodyShape::Vehicle { .. } => Livery::draw(&walker.clothes_seed).colours(&walker.body),
        };
        colours[..clothes.colours.len()].copy_from_slice(&clothes.colours);
        let (sin, cos) = real::sin_cos(walker.state.heading_rad);
        let side_in_world = Vec3::new(-sin as f32, cos as f32, 0.0);
        self.members.push(Person {
            walker,
            clothes,
            colours,
            side_in_world,
            instance,
            triangles,
            is_seen,
            reach,
            height_px,
        });
    }
}

/// An upright box around a body, its shadow left out.
pub(crate) struct Bounds {
    low: DVec3,
    high: DVec3,
    foot_m: f64,
    /// Ground that its lamps light, from the body on: along x and y to either side, metres.
    lit_m: [DVec2; 2],
}

impl Bounds {
    pub fn new(walker: &Walker) -> Self {
        let (low, high) = walker.bounds_in_world();
        Self { low, high, foot_m: walker.state.feet_in_world.z, lit_m: headlights::reach_m(walker) }
    }

    fn is_in_view(&self, eye: &Eye, screen: &Screen) -> bool {
        eye.order_if_seen(screen, 0.5 * (self.low + self.high), 0.5 * (self.high - self.low)).is_some()
    }

    fn height_px(&self, walker: &Walker, eye: &Eye, screen: &Screen) -> f64 {
        let away_m = (eye.position_in_world - eye.position_in_world.clamp(self.low, self.high)).length();
        screen.focal_px * walker.body.height_m(walker.height_m) / away_m.max(NEAR_M)
    }

    /// Whether the body is large enough to be drawn, and it, its shadow or the light of its lamps may be in view.
    pub fn may_matter(&self, walker: &Walker, eye: &Eye, screen: &Screen, far: FarLight) -> bool {
        self.height_px(walker, eye, screen) >= LEAST_HEIGHT_PX && self.with_shadow(far).is_in_view(eye, screen)
    }

    /// Way along the sun's rays down to the lowest ground that counts.
    fn fall(&self, from_m: f64, to_sun: DVec3) -> DVec3 {
        Self::fall_to(self.foot_m - DROP_M, from_m, to_sun)
    }

    /// Way along the sun's rays from one height down to another, metres.
    fn fall_to(lowest_m: f64, from_m: f64, to_sun: DVec3) -> DVec3 {
        -to_sun * ((from_m - lowest_m).max(0.0) / to_sun.z.max(0.02))
    }

    /// The box and the ground that its lamps light.
    fn with_lamps(&self, far: FarLight) -> Self {
        let [before, beyond] = if far.is_night { self.lit_m } else { [DVec2::ZERO; 2] };
        Self { low: self.low - before.extend(0.0), high: self.high + beyond.extend(0.0), ..*self }
    }

    fn with_shadow(&self, far: FarLight) -> Self {
        let (below, tip) = (self.fall(self.low.z, far.to_sun), self.fall(self.high.z, far.to_sun));
        let lit = self.with_lamps(far);
        Self {
            low: lit.low.min(self.low + below).min(self.low + tip),
            high: lit.high.max(self.high + below).max(self.high + tip),
            ..*self
        }
    }

    fn corners(&self, margin_m: f64) -> impl Iterator<Item = DVec3> {
        let ends = [self.low - margin_m, self.high + margin_m];
        (0..8).map(move |k| DVec3::new(ends[k & 1].x, ends[k >> 1 & 1].y, ends[k >> 2].z))
    }

    /// The body and all that it may darken or light: its box, and the same box at the end of the sun's rays.
    fn reach(&self, eye: &Eye, screen: &Screen, far: FarLight) -> Reach {
        let lit = self.with_lamps(far);
        let corners = lit.corners(MARGIN_M).flat_map(|corner| [corner, corner + self.fall(corner.z, far.to_sun)]);
        Reach::around(screen, corners.map(|corner| eye.see(corner)))
    }

    /// Corners of a hull of the body and all that it may darken or light above `lowest_m`.
    pub fn hull(&self, lowest_m: f64, far: FarLight) -> [DVec3; 16] {
        let lowest_m = lowest_m.max(self.foot_m - DROP_M);
        let mut hull = [DVec3::ZERO; 16];
        for (pair, corner) in hull.chunks_exact_mut(2).zip(self.with_lamps(far).corners(MARGIN_M)) {
            pair.copy_from_slice(&[corner, corner + Self::fall_to(lowest_m - MARGIN_M, corner.z, far.to_sun)]);
        }
        hull
    }

    fn is_hidden(&self, eye: &Eye, screen: &Screen, drawn: &Nearer) -> bool {
        let Reach([left, top, right, bottom]) = Reach::around(screen, self.corners(0.0).map(|corner| eye.see(corner)));
        let nearest_m = self.corners(0.0).map(|corner| eye.see(corner).x).fold(f64::INFINITY, f64::min);
        nearest_m >= NEAR_M && drawn.hides([left, top], [right, bottom], 1.0 / nearest_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{BodyKind, Camera};
    use cosfly_figures::{BodyShape, walker_triangles};
    use cosfly_frames::{Pose, Seed, TargetState};

    #[test]
    fn a_body_and_its_shadow_stay_within_reach() {
        let camera = Camera { width: 640, height: 480, horizontal_fov_rad: 1.4 };
        let screen = Screen::new(&camera);
        let eye = Eye::new(&Pose::looking_at(DVec3::new(-12.0, 3.0, 9.0), DVec3::new(0.0, 0.0, 1.0)));
        for step in 0..24 {
            let turn = f64::from(step) * 0.7;
            let walker = Walker {
                state: TargetState { feet_in_world: DVec3::new(0.3, -1.0, 0.2), heading_rad: turn, speed_mps: 1.6 },
                height_m: 1.8,
                radius_m: 0.3,
                clothes_seed: Seed([step as u8; 32]),
                gait_phase_rad: 1.3 * turn,
                body: match step % 3 {
                    0 => BodyShape::Person { umbrella: step % 2 == 0 },
                    1 => BodyShape::Vehicle { kind: BodyKind::Bus, size_m: DVec3::new(5.0, 2.5, 3.0) },
                    _ => BodyShape::Vehicle { kind: BodyKind::Bicycle, size_m: DVec3::new(1.8, 0.65, 1.75) },
                },
            };
            let to_sun = DVec3::new(libm::cos(turn), libm::sin(turn), 0.3 + 0.1 * turn).normalize();
            let bounds = Bounds::new(&walker);
            let far = FarLight { to_sun, is_night: step % 2 == 0 };
            let Reach([left, top, right, bottom]) = bounds.reach(&eye, &screen, far);
            let shaded = bounds.with_shadow(far);
            for corner in walker_triangles(&walker).into_iter().flatten() {
                let tip = corner - to_sun * ((corner.z + 1.0) / to_sun.z);
                for point in [corner, 0.5 * (corner + tip), tip] {
                    let seen = eye.see(point);
                    let scale = screen.focal_px / seen.x;
                    let (u, v) = (screen.center_u + seen.y * scale, screen.center_v - seen.z * scale);
                    assert!((left..right).contains(&u) && (top..bottom).contains(&v), "{step}: {u} {v}");
                    assert!(point.cmpge(shaded.low - 1e-9).all() && point.cmple(shaded.high + 1e-9).all(), "{step}");
                }
            }
        }
    }

    #[test]
    fn reach_is_tested_by_pixels() {
        let reach = Reach([10.5, 4.0, 20.0, 6.5]);
        assert!(reach.meets_rows(6..7) && !reach.meets_rows(7..9) && !reach.meets_rows(0..4));
        assert_eq!(reach.pixels(), [10, 4, 20, 7]);
        assert!(Reach::EVERYWHERE.meets_rows(0..1));
        assert_eq!(Reach::EVERYWHERE.pixels(), [i32::MIN, i32::MIN, i32::MAX, i32::MAX]);
    }
}

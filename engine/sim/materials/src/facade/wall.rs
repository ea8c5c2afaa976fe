//! [`Facade`]: what a building's seed and family draw for a face, and its bare wall.

use super::draws;
use super::family::{Family, SIGNS, between, chance};
use crate::building_form::BuildingForm;
use crate::parts::SceneBox;
use crate::pattern::{NoiseLevel, NoiseTexture, Noises, band, draw, hash, one_if, smoothstep, stripes};
use crate::street_walls::IN_STREET_M;
use crate::surface::{Look, SurfacePoint};
use crate::vector::Vec3;

/// Texels of the plaster's grain per metre.
pub(super) const GRAIN_PER_M: f32 = 14.0;
/// Height of the darker foot of a wall, and of its cornice, metres.
const FOOT_M: f32 = 2.2;
const CORNICE_M: f32 = 0.45;

/// Share of the walls of houses with a door in any case.
const DOORED_WALLS: f32 = 0.6;

/// Half the width and height of a wall below which no window is in it, metres.
const SMALLEST_HALF_M: f32 = 0.8;

/// Properties of a whole facade.
#[derive(Clone, Copy, Debug)]
pub struct Facade {
    pub(super) seed: u32,
    pub(super) wall: Vec3,
    pub(super) trim: Vec3,
    pub(super) rail: Vec3,
    pub(super) door: Vec3,
    pub(super) bays_per_m: f32,
    pub(super) floors_per_m: f32,
    pub(super) floor_m: f32,
    pub(super) floors: f32,
    pub(super) window: [f32; 2],
    pub(super) sill: [f32; 2],
    /// Depth of the panes in the wall, metres.
    pub(super) reveal_m: f32,
    /// Share of a mirror in the glass.
    pub(super) gloss: f32,
    /// How much its panes differ in what they mirror.
    pub(super) uneven: f32,
    /// Light of cloth that its glass lets out.
    pub(super) clear: f32,
    /// 1 where windows have a bar in the middle.
    pub(super) mullions: f32,
    /// 1 for walls of bricks.
    pub(super) brick: f32,
    /// Strength of ledges and of joints between panels.
    pub(super) ledge: f32,
    pub(super) joint: f32,
    /// Height of either, share of a storey.
    pub(super) course: f32,
    /// Strength of dirt.
    pub(super) age: f32,
    /// Share of the columns of bays that have balconies.
    pub(super) balconies: f32,
    pub(super) shops: bool,
    /// Whether the wall stands in the street: doors are there.
    pub(super) has_doors: bool,
    /// Share of the bays with a door, half its width and its height, metres.
    pub(super) doors: [f32; 3],
    /// A bay that has a door in any case; -1 for none.
    pub(super) door_bay: f32,
    pub(super) height_m: f32,
    pub(super) shift: f32,
}

impl Facade {
    /// The facade of a building `seed` in a town on a face of this size; `house` is the form and height of the whole building.
    pub fn new(seed: u32, town: u32, face: u32, [width_m, height_m]: [f32; 2], house: (BuildingForm, f32)) -> Self {
        let family = Family::of(seed, town, house);
        let [wall, trim] = family.colours(seed);
        let floors = (height_m / between(family.storey_m, seed, draws::STOREY)).round().max(1.0);
        let bay_m = width_m / (width_m / between(family.bay_m, seed, draws::BAY)).round().max(1.0);
        let share = between(family.share, seed, draws::WINDOW);
        let rails = [Vec3::splat(0.06), Vec3::splat(0.5), trim, Vec3::new(0.16, 0.22, 0.24)];
        Self {
            seed: hash(seed, face),
            wall,
            trim,
            rail: rails[(draw(seed, draws::RAIL) * 4.0) as usize % 4],
            door: SIGNS[(draw(seed, draws::DOOR) * 8.0) as usize % 8] * 0.6,
            bays_per_m: 1.0 / bay_m,
            floors_per_m: floors / height_m,
            floor_m: height_m / floors,
            floors,
            window: [0.5 - 0.5 * share, 0.5 + 0.5 * share],
            sill: [between(family.sill[0], seed, draws::SILL), between(family.sill[1], seed, draws::LINTEL)],
            reveal_m: family.reveal_m,
            gloss: family.gloss,
            uneven: 0.4,
            // Where all is glass, it is tinted: walls are no chequers of blinds.
            clear: if share > 0.8 { 0.3 } else { 1.0 },
            mullions: if family.mullion { 1.0 } else { 0.0 },
            brick: if family.brick { 1.0 } else { 0.0 },
            ledge: family.ledge,
            joint: family.joint,
            course: if family.joint > 0.0 { 0.012 } else { 0.05 },
            age: between(family.age, seed, draws::AGE),
            // Streets have more of them than yards.
            balconies: if floors > 1.5 {
                chance(family.balconies, hash(seed, face), draws::BALCONIES) * 0.55
            } else {
                0.0
            },
            shops: family.has_shops(seed, house.0) && height_m > 5.0,
            has_doors: family.door[0] > 0.0,
            doors: family.door,
            door_bay: door_bay(hash(seed, face), house.0, (width_m / bay_m).round()),
            height_m,
            shift: 200.0 * draw(seed, draws::SHIFT),
        }
    }

    /// The facade of an upright face of a building's box: of the whole building's kind.
    pub fn of_box(b: &SceneBox, face: usize, half_width_m: f32) -> Self {
        let ([middle, half_whole], half_m) = (b.whole, b.half_extents_m.z);
        let look = Self::new(b.seed, b.town, face as u32, [2.0 * half_width_m, 2.0 * half_m], house_of(b));
        if half_width_m.min(half_m) < SMALLEST_HALF_M {
            look.bare()
        } else if b.center_in_world.z as f32 - half_m > middle.z - half_whole.z + IN_STREET_M as f32 {
            look.above_street()
        } else {
            Self { shops: look.shops && b.is_at_street.get(face).is_some_and(|is_at| *is_at), ..look }
        }
    }

    /// The facade of a part that stands above the street, on a lower part or out of a wall: no shop and no door is there.
    pub fn above_street(self) -> Self {
        Self { shops: false, has_doors: false, ..self }
    }

    /// Wall of this kind without anything in it: a gable, or a part that is too small for a window.
    pub fn bare(self) -> Self {
        let bare = Self { window: [0.5; 2], balconies: 0.0, ledge: 0.0, joint: 0.0, ..self.above_street() };
        // No cornice.
        Self { height_m: self.height_m + 100.0, ..bare }
    }

    /// The colour of its wall.
    #[inline(always)]
    pub fn wall_colour(&self) -> Vec3 {
        self.wall
    }

    /// The wall at `along_m` from one edge and `up_m` above the building's foot, and how much of the place is opening.
    #[inline(always)]
    pub(super) fn wall_and_opening(&self, point: &SurfacePoint, [along_m, up_m]: [f32; 2], wall: Vec3) -> (Look, f32) {
        let (bay, floor) = (along_m * self.bays_per_m, up_m * self.floors_per_m);
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1] * self.floors_per_m);
        // A ledge between storeys, or the joint between panels.
        let ledge = stripes(floor, 0.0, self.course, dv);
        let wall = wall.lerp(self.trim, self.ledge * ledge) * (1.0 - self.joint * ledge);
        let openings = one_if(floor < self.floors - 0.02);
        let opening = openings
            * stripes(bay, self.window[0], self.window[1], du)
            * stripes(floor, self.sill[0], self.sill[1], dv);
        (Look::matt(wall, point.normal), opening)
    }

    /// Streaks of dirt under sills and roofs: the share of light that they leave.
    #[inline(always)]
    pub(super) fn dirt(&self, point: &SurfacePoint, [along_m, up_m]: [f32; 2], noise: &NoiseTexture) -> f32 {
        let streak = noise.clumps(along_m * 11.0 + self.shift, up_m * 1.3 + self.shift, point.footprint_m * 5.0);
        1.0 - self.age * 0.5 * smoothstep(0.42, 0.80, streak)
    }

    /// Grain of the plaster.
    #[inline(always)]
    pub(super) fn grain(&self, along_m: f32, up_m: f32, fine: NoiseLevel, noise: &NoiseTexture) -> f32 {
        noise.rough_at(along_m * GRAIN_PER_M + self.shift, up_m * GRAIN_PER_M, fine)
    }

    /// Joints between courses of bricks.
    #[inline(always)]
    pub(super) fn courses(&self, point: &SurfacePoint, up_m: f32) -> f32 {
        let course = stripes(up_m / 0.08, 0.0, 0.17, point.footprints_m[1] / 0.08);
        1.0 - self.brick * one_if(point.footprint_m < 0.1) * 0.25 * course
    }

    /// Plaster or brick, with the share of light that the foot of the wall leaves.
    #[inline(always)]
    pub(super) fn plaster(&self, grain: f32, foot: f32, dirt: f32, courses: f32) -> Vec3 {
        self.wall * ((0.78 + 0.44 * grain) * foot * dirt * courses)
    }

    /// The bare wall: plaster or brick, a base of darker stone and a cornice.
    #[inline(always)]
    pub(super) fn wall_at(&self, point: &SurfacePoint, up_m: f32, grain: f32, dirt: f32, courses: f32) -> Vec3 {
        let foot = 1.0 - (0.15 + 0.2 * self.age) * (1.0 - smoothstep(0.0, FOOT_M, up_m));
        let wall = self.plaster(grain, foot, dirt, courses);
        let dv = point.footprints_m[1];
        let base = band(up_m, -1.0, 0.55, dv);
        let wall = wall.lerp(Vec3::splat(0.20) * (0.6 + 0.6 * grain), 0.7 * base);
        let crown = band(up_m, self.height_m - CORNICE_M, self.height_m + 1.0, dv);
        wall.lerp(self.trim * 0.9, crown)
    }

    /// Whether a wall is bare of base and cornice at a place.
    #[inline(always)]
    pub(super) fn is_middle(&self, point: &SurfacePoint, up_m: f32) -> bool {
        let dv = point.footprints_m[1];
        (up_m - dv > FOOT_M) & (up_m + dv < self.height_m - CORNICE_M)
    }
}

/// The bay of the door that most walls of houses have; -1 for none.
fn door_bay(seed: u32, form: BuildingForm, bays: f32) -> f32 {
    let is_house = matches!(form, BuildingForm::Home | BuildingForm::Roofed);
    let has_door = is_house && bays > 1.5 && draw(seed, draws::HAS_DOOR) < DOORED_WALLS;
    if has_door { (draw(seed, draws::DOOR_BAY) * bays).floor() } else { -1.0 }
}

/// Form and height of the building of a box.
fn house_of(b: &SceneBox) -> (BuildingForm, f32) {
    (b.form, 2.0 * b.whole[1].z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::{boxes_of, join_wholes};
    use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox, Town};
    use cosfly_frames::DVec3;

    #[test]
    fn cloth_behind_walls_of_glass_is_dark() {
        for seed in 0..300 {
            let facade = Facade::new(seed, 1, 0, [30.0, 40.0], (BuildingForm::Block, 40.0));
            let is_glass = facade.window[1] - facade.window[0] > 0.8;
            assert_eq!(is_glass, facade.clear < 0.5, "{facade:?}");
        }
    }

    #[test]
    fn boxes_of_a_building_have_one_wall_and_doors_in_the_street_alone() {
        let part = |low: DVec3, high: DVec3, object_id| Obstacle {
            shape: OrientedBox::from_corners(low, high),
            kind: ObstacleKind::Building,
            object_id,
            synthetic: false,
        };
        for object_id in 0..40 {
            let attic = part(DVec3::new(2.0, 2.0, 18.0), DVec3::new(18.0, 8.0, 21.0), object_id);
            let obstacles = vec![part(DVec3::ZERO, DVec3::new(20.0, 10.0, 18.0), object_id), attic];
            let mut boxes = boxes_of(&Town { obstacles, ..Town::default() }, 7);
            join_wholes(&mut boxes);
            let [lower, upper] = [0, 1].map(|number: usize| Facade::of_box(&boxes[number], 2, 10.0));
            assert_eq!(lower.wall_colour(), upper.wall_colour());
            assert!(lower.has_doors && !upper.has_doors && !upper.shops);
        }
    }

    #[test]
    fn houses_have_shops_at_the_street_alone_and_most_walls_a_door() {
        let (mut shops, mut doors) = (0, 0);
        for object_id in 0..200 {
            let shape = OrientedBox::from_corners(DVec3::ZERO, DVec3::new(20.0, 10.0, 12.0));
            let one = Obstacle { shape, kind: ObstacleKind::Building, object_id, synthetic: false };
            let mut boxes = boxes_of(&Town { obstacles: vec![one], ..Town::default() }, 7);
            join_wholes(&mut boxes);
            boxes[0].form = BuildingForm::Roofed;
            assert!((0..4).all(|face| !Facade::of_box(&boxes[0], face, 10.0).shops));
            boxes[0].is_at_street[2] = true;
            let looks = [0, 1, 2, 3].map(|face| Facade::of_box(&boxes[0], face, 10.0));
            assert!([0, 1, 3].iter().all(|face| !looks[*face].shops));
            shops += usize::from(looks[2].shops);
            doors += looks.iter().filter(|look| (0.0..20.0 * look.bays_per_m).contains(&look.door_bay)).count();
        }
        assert!((80..180).contains(&shops) && (420..540).contains(&doors), "{shops} {doors}");
    }
}

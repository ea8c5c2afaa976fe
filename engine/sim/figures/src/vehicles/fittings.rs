//! Fittings on and behind the sheet of a vehicle that are no shapes: gaps of doors and lids, seats, dirt.

use super::cars;
use super::lorries::Load;
use super::shapes::Shape;
use crate::body_figure::BodyFigure;
use crate::body_shape::BodyShape;
use crate::region::Region;
use cosfly_domain::BodyKind;
use cosfly_frames::{DVec3, RandomStream};

/// Places of gaps and seats, shares of the box: x forward of its middle, z up from its foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fittings {
    /// Size of the box, metres.
    pub size_m: DVec3,
    /// Gaps of the doors, from the front.
    pub doors: [f64; 3],
    /// Lower and upper end of those gaps.
    pub door_heights: [f64; 2],
    /// Both ends of the bonnet.
    pub bonnet: [f64; 2],
    /// Both ends of the boot's lid.
    pub boot: [f64; 2],
    /// Gutters of the roof, from the middle, shares of the width.
    pub gutter: f64,
    /// Upper edge of the bumpers.
    pub bumper: f64,
    /// Lamps at the tail: place that they begin at, from the middle, in half widths of the box; lower and upper edge.
    pub tail_lamps: [f64; 3],
    /// Upper edge of the dark lower part of the bumpers.
    pub skirt: f64,
    /// Middle of the number plate at the tail.
    pub rear_plate: f64,
    /// A sign on the sides of a van, a lorry's box or a bus.
    pub sign: Sign,
    /// Whether it opens behind by two doors, as boxes of lorries and vans without windows do.
    pub has_rear_doors: bool,
    /// Backs of the rows of seats.
    pub seats: [f64; 2],
    /// How dirty the vehicle is, 0..=1.
    pub dirt: f64,
    /// Whether the paint has flakes of metal: it is darker where it is seen along.
    pub flakes: bool,
}

/// A word and a band on both sides of a vehicle, shares of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sign {
    /// Linear RGB.
    pub colour: [f32; 3],
    /// Back and front end of the word; its lower and upper edge.
    pub word: [f64; 2],
    pub heights: [f64; 2],
    /// Lower and upper edge of the band.
    pub band: [f64; 2],
    /// Which letters the word has.
    pub letters: u32,
}

/// Colours of signs, linear RGB.
const SIGNS: [[f32; 3]; 6] = [
    [0.45, 0.02, 0.02],
    [0.02, 0.06, 0.32],
    [0.02, 0.20, 0.06],
    [0.02, 0.02, 0.025],
    [0.60, 0.22, 0.01],
    [0.03, 0.25, 0.42],
];

impl Sign {
    const NONE: Self =
        Self { colour: [0.0; 3], word: [NOWHERE; 2], heights: [0.0; 2], band: [-NOWHERE; 2], letters: 0 };

    /// The sign that a vehicle draws: two of three lorries and vans without windows have a word, all buses a band.
    fn draw(kind: BodyKind, has_panes: bool, looks: &mut RandomStream) -> Self {
        let (colour, letters) = (SIGNS[looks.index(SIGNS.len())], looks.index(1 << 16) as u32);
        let is_signed = looks.chance(0.67);
        let bare = Self { colour, letters, ..Self::NONE };
        match kind {
            BodyKind::Truck if is_signed => {
                let band = if looks.chance(0.5) { [0.34, 0.44] } else { bare.band };
                Self { word: [-0.44, looks.uniform(0.02, 0.2)], heights: [0.56, 0.82], band, ..bare }
            }
            BodyKind::Van if is_signed && !has_panes => {
                Self { word: [-0.40, looks.uniform(-0.12, 0.04)], heights: [0.58, 0.74], ..bare }
            }
            // Half of them are painted up to the windows.
            BodyKind::Bus => {
                let top = if looks.chance(0.5) { 0.42 } else { looks.uniform(0.24, 0.36) };
                Self { band: [0.10, top], ..bare }
            }
            _ => Self::NONE,
        }
    }
}

/// A place that no body reaches.
const NOWHERE: f64 = 9.0;

impl Fittings {
    /// Those of a body.
    pub fn of(figure: &BodyFigure) -> Self {
        let mut looks = figure.clothes_seed.stream("dirt");
        let dirt = looks.unit() * looks.unit();
        let flakes = looks.chance(0.7);
        let bare = Self {
            size_m: DVec3::ONE,
            doors: [NOWHERE; 3],
            door_heights: [0.0; 2],
            bonnet: [NOWHERE; 2],
            boot: [-NOWHERE; 2],
            gutter: NOWHERE,
            bumper: NOWHERE,
            tail_lamps: [NOWHERE; 3],
            skirt: -NOWHERE,
            rear_plate: NOWHERE,
            sign: Sign::NONE,
            has_rear_doors: false,
            seats: [NOWHERE; 2],
            dirt,
            flakes,
        };
        match figure.body {
            BodyShape::Vehicle { kind: kind @ (BodyKind::Car | BodyKind::Van), size_m } => {
                let shape = cars::shape(kind, size_m, &mut figure.clothes_seed.stream("shape"));
                let tail_lamps = tail_lamps(shape, &mut looks);
                let has_rear_doors = cars::has_bare_sides(shape);
                let sign = Sign::draw(kind, !has_rear_doors, &mut looks);
                Self { size_m, tail_lamps, sign, has_rear_doors, ..bare.with(shape) }
            }
            BodyShape::Vehicle { kind, size_m } => {
                let has_rear_doors =
                    kind == BodyKind::Truck && Load::draw(&mut figure.clothes_seed.stream("shape")) == Load::Box;
                Self { size_m, sign: Sign::draw(kind, true, &mut looks), has_rear_doors, ..bare }
            }
            BodyShape::Person { .. } => bare,
        }
    }

    fn with(self, shape: &Shape) -> Self {
        let Some(cowl) = cars::cowl(shape) else { return self };
        let pillar = shape.sections.iter().rfind(|section| section.regions[1] == Region::Trim);
        let middle = pillar.map_or(cowl.x - 0.26, |section| section.x + 0.01);
        let panes = shape.sections.iter().find(|section| section.regions[1] == Region::Glass);
        let rear = panes.map_or(NOWHERE, |section| section.x.max(shape.axles[0] + 0.075));
        let boot = shape.sections.iter().find(|it| it.regions[2] == Region::Glass && !it.roofed && it.x > -0.44);
        let has_rear = rear < middle - 0.08;
        Self {
            doors: [cowl.x - 0.045, middle, if has_rear { rear } else { NOWHERE }],
            door_heights: [shape.foot + 0.07, cowl.shoulder],
            bonnet: [cowl.x, 0.45],
            boot: boot.map_or([-NOWHERE; 2], |section| [-0.462, section.x - 0.012]),
            gutter: 0.415 * shape.tumble,
            bumper: shape.foot + 0.24,
            skirt: cars::skirt(shape),
            rear_plate: shape.sections.first().map_or(NOWHERE, |tail| cars::rear_plate(shape, tail) + 0.032),
            seats: [middle, if has_rear { middle - 0.19 } else { NOWHERE }],
            ..self
        }
    }
}

/// Lamps at the tail: upright ones at the corners, level ones that reach inwards, or a band from side to side.
fn tail_lamps(shape: &Shape, looks: &mut RandomStream) -> [f64; 3] {
    let top = shape.sections.get(1).map_or(0.55, |section| section.shoulder);
    if top < 0.5 || looks.chance(0.3) {
        [0.74, top - 0.22, top + 0.01]
    } else {
        let inner = if looks.chance(0.15) { 0.0 } else { looks.uniform(0.45, 0.62) };
        [inner, top - looks.uniform(0.09, 0.14), top + 0.01]
    }
}

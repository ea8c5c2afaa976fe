//! Cars and vans from the rows of their shapes.

use super::model::{Model, SHEET_M};
use super::shapes::{CARS, Section, Shape, VANS};
use super::shell::{MOST_SECTIONS, POINTS, Shell};
use super::wheels::{Axle, Rim, turn_rad};
use crate::region::Region;
use cosfly_domain::BodyKind;
use cosfly_frames::{DVec3, RandomStream};

/// Half the width of panels at both ends, in half widths.
const END: [f64; 2] = [0.494, 0.494];

/// Height of the crease along the sides between foot and shoulder, a share.
const CREASE: f64 = 0.62;

/// The shape of a car or van of a size: one of those that fit, drawn by their shares.
pub(super) fn shape(kind: BodyKind, size_m: DVec3, looks: &mut RandomStream) -> &'static Shape {
    let all: &'static [Shape] = if kind == BodyKind::Van { &VANS } else { &CARS };
    let is_within = |[low, high]: [f64; 2], value: f64| (low..=high).contains(&value);
    let fits = |it: &&Shape| is_within(it.lengths_m, size_m.x) && is_within(it.heights_m, size_m.z);
    let total: f64 = all.iter().filter(fits).map(|it| it.share).sum();
    let mut left = total * looks.unit();
    let drawn = all.iter().filter(fits).find(|it| {
        left -= it.share;
        left < 0.0
    });
    drawn.unwrap_or(&all[0])
}

/// A car or van; `phase_rad` turns its wheels.
pub(super) fn car(model: &mut Model<'_>, shape: &Shape, phase_rad: f64, looks: &mut RandomStream) {
    let mut shell = shell(model, shape);
    if shape.rails && looks.chance(0.6) {
        rails(model, shape);
    } else if looks.chance(0.25) {
        roof_window(&mut shell, shape);
    }
    shell.draw(model);
    if let Some([first, _]) = roof_ends(shape) {
        let fin = [[first + 0.02, 0.93], [first + 0.06, 0.93], [first + 0.025, 0.995]];
        model.hull(Region::Paint, &fin, [0.012, 0.006]);
    }
    ends(model, shape);
    if has_bare_sides(shape) && looks.chance(0.6) {
        for ys in [[-0.68, -0.08], [0.08, 0.68]] {
            model.cross_panel(Region::Glass, [[-0.5, 0.58], [-0.496, 0.82]], ys, END);
        }
    }
    mirrors(model, shape, 0.14, Region::Paint);
    let radius_m = shape.wheel * model.size_m.z;
    let rim = Rim::Open(turn_rad(phase_rad, model.size_m.z, radius_m));
    for x in shape.axles {
        let arch_from_m = Some(shape.foot * model.size_m.z);
        let (x_m, half_width_m) = (x * model.size_m.x, (shape.sheet + 0.014) * model.size_m.y);
        model.axle(&Axle { x_m, half_width_m, radius_m, arch_from_m, rim });
    }
}

/// Whether no windows are behind the seats in front, as in vans for goods.
pub(super) fn has_bare_sides(shape: &Shape) -> bool {
    let is_pane = |it: &Section| it.regions[1] == Region::Glass || it.regions[2] == Region::Glass;
    !shape.sections.iter().any(|it| it.x < -0.1 && is_pane(it))
}

/// Half the width of the sheet, in widths: both ends are rounded.
fn half_width(shape: &Shape, x: f64) -> f64 {
    let t = ((x.abs() - 0.3) / 0.2).clamp(0.0, 1.0);
    let (t2, t4) = (t * t, t * t * t * t);
    shape.sheet * (1.0 - 0.05 * t2 - shape.narrow * t4 * t2)
}

/// Cross-sections of a shape.
pub(super) fn shell(model: &Model<'_>, shape: &Shape) -> Shell {
    let mut shell = Shell {
        points: [[DVec3::ZERO; POINTS]; MOST_SECTIONS],
        regions: [[Region::Paint; POINTS - 1]; MOST_SECTIONS],
        count: shape.sections.len().min(MOST_SECTIONS),
    };
    let mut before = Region::Paint;
    for (number, section) in shape.sections.iter().enumerate().take(MOST_SECTIONS) {
        let [low, side, over] = section.regions;
        // Panes across the car are bent outwards.
        let is_pane = over == Region::Glass || before == Region::Glass;
        let bow = if is_pane { 0.018 * section.x.signum() } else { 0.0 };
        before = over;
        let bend = |[x, y, z]: [f64; 3]| {
            let w = half_width(shape, section.x);
            let x_m = (x + bow * (1.0 - (y / w) * (y / w))) * model.size_m.x;
            let most_m = 0.5 * model.size_m.x - SHEET_M;
            DVec3::new(x_m.clamp(-most_m, most_m), y * model.size_m.y, z * model.size_m.z)
        };
        shell.points[number] = outline(shape, section).map(bend);
        let sill = if shape.cladding { Region::Trim } else { Region::Paint };
        let pillar = match (side, over) {
            // Lamps reach round the corners.
            (Region::HeadLamp | Region::TailLamp, _) => side,
            // Pillars beside panes are painted.
            (_, Region::Trim | Region::Glass) => Region::Paint,
            _ => over,
        };
        shell.regions[number] = [sill, Region::Paint, low, side, pillar, over, over];
    }
    shell
}

/// How far the sheet of an end rises above that of the sides, in heights.
fn end_rise(x: f64) -> f64 {
    if x < 0.0 { 0.085 } else { 0.05 }
}

/// Points of the right half of a cross-section from sill to roof, in box sizes.
fn outline(shape: &Shape, section: &Section) -> [[f64; 3]; POINTS] {
    let Section { x, shoulder, top, roofed, .. } = *section;
    let w = half_width(shape, x);
    // Both ends rise above the ground: behind, the tyres are seen below.
    let rise = ((x.abs() - 0.38) / 0.12).clamp(0.0, 1.0);
    let foot = shape.foot + end_rise(x) * rise * rise;
    let at = |y: f64, z: f64| [x, y * w, z];
    let height = shoulder - foot;
    let crease = at(1.0, foot + CREASE * height);
    let lower = [at(0.93, foot), at(0.965, foot + 0.26 * height), crease, at(shape.tumble.max(0.94), shoulder)];
    let upper = if roofed {
        let drop = shape.drop;
        let edge = shape.tumble;
        [at(edge, top - drop), at(0.90 * edge, top - 0.35 * drop), at(0.55 * edge, top - 0.08 * drop), at(0.0, top)]
    } else {
        let drop = top - shoulder;
        [at(0.92, top - 0.45 * drop), at(0.79, top - 0.14 * drop), at(0.4, top - 0.03 * drop), at(0.0, top)]
    };
    core::array::from_fn(|k| if k < 4 { lower[k] } else { upper[k - 4] })
}

/// Grille, air intake, plates.
fn ends(model: &mut Model<'_>, shape: &Shape) {
    let (Some(tail), Some(nose)) = (shape.sections.first(), shape.sections.last()) else { return };
    let foot = shape.foot + end_rise(1.0);
    let reach = 1.0 - shape.narrow - 0.12;
    model.cross_panel(Region::Trim, [[0.5, foot + 0.01], [0.5, foot + 0.075]], [-reach, reach], END);
    model.cross_panel(Region::Plate, [[0.5, foot + 0.085], [0.5, foot + 0.15]], [-0.28, 0.28], END);
    let grille = [[0.5, foot + 0.16], [0.5, nose.shoulder.max(foot + 0.2)]];
    model.cross_panel(Region::Trim, grille, [-0.8 * reach, 0.8 * reach], END);
    let plate = rear_plate(shape, tail);
    model.cross_panel(Region::Plate, [[-0.5, plate], [-0.5, plate + 0.065]], [-0.28, 0.28], END);
}

/// Lower edge of the number plate at the tail.
pub(super) fn rear_plate(shape: &Shape, tail: &Section) -> f64 {
    (tail.shoulder - 0.10).max(skirt(shape) + 0.02)
}

/// Upper edge of the dark lower part of both bumpers.
pub(super) fn skirt(shape: &Shape) -> f64 {
    shape.foot + end_rise(-1.0) + 0.065
}

/// Mirrors beside the windscreen, of a height in metres.
pub(super) fn mirrors(model: &mut Model<'_>, shape: &Shape, tall_m: f64, region: Region) {
    let Some(cowl) = cowl(shape) else { return };
    let size_m = model.size_m;
    let back_m = cowl.x * size_m.x - 0.42;
    let low_m = cowl.shoulder * size_m.z + 0.01;
    let high_m = low_m + tall_m;
    for sign in [-1.0, 1.0] {
        let at = |x_m: f64, y: f64, z_m: f64| DVec3::new(x_m, sign * y * size_m.y, z_m);
        let (inner, outer) = (0.44, 0.5);
        let rear = [(inner, low_m), (outer, low_m + 0.03), (outer, high_m), (inner, high_m)];
        let rear = rear.map(|(y, z_m)| at(back_m, y, z_m));
        let front = rear.map(|point| point + DVec3::X * 0.12);
        let inside = 0.5 * (rear[0] + front[2]);
        model.face(Region::Trim, &rear, inside);
        model.face(region, &front, inside);
        for k in 0..3 {
            model.face(region, &[rear[k], rear[k + 1], front[k + 1], front[k]], inside);
        }
    }
}

/// The foot of the windscreen.
pub(super) fn cowl(shape: &Shape) -> Option<&Section> {
    let pane = shape.sections.iter().rposition(|section| section.regions[2] == Region::Glass)?;
    shape.sections.get(pane + 1)
}

/// First and last place of the roof.
fn roof_ends(shape: &Shape) -> Option<[f64; 2]> {
    let mut roof = shape.sections.iter().filter(|section| section.roofed).map(|section| section.x);
    let first = roof.next()?;
    Some([first, roof.next_back()?])
}

/// Bars along both edges of the roof.
fn rails(model: &mut Model<'_>, shape: &Shape) {
    let Some([first, last]) = roof_ends(shape) else { return };
    let size_m = model.size_m;
    let y_m = 0.9 * shape.tumble * shape.sheet * size_m.y;
    let (z_m, thick_m) = (0.993 * size_m.z - 0.02, 0.035);
    for sign in [-1.0, 1.0] {
        let at = |x: f64| DVec3::new(x * size_m.x, sign * y_m, z_m);
        model.bar(Region::Trim, at(first + 0.03), at(last - 0.03), thick_m);
    }
}

/// A pane in the roof above the seats.
fn roof_window(shell: &mut Shell, shape: &Shape) {
    // Sheet stays above the windscreen.
    let rows = shape.sections.windows(2).zip(&mut shell.regions);
    for (pair, regions) in rows.filter(|(pair, _)| pair[0].roofed && pair[1].roofed && pair[0].x > -0.25) {
        if pair[0].regions[2] == Region::Paint && pair[1].regions[2] != Region::Glass {
            regions[5] = Region::Glass;
            regions[6] = Region::Glass;
        }
    }
}

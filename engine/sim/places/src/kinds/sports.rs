//! Sports fields: a lawn or a hard court with painted lines and two goals.

use crate::geometry::{disc, edges, rectangle};
use crate::lot::Lot;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, real};

/// Width of painted lines, metres.
const LINE_M: f64 = 0.12;
/// Room around the outer lines, metres.
const ROOM_M: f64 = 3.0;

/// A sports field around `center`, if its ground is free; a fence of some height stands around hard courts.
pub fn sports_field(site: &mut Site, center: DVec2, along: DVec2, size_m: DVec2, is_hard: bool) -> bool {
    let across = along.perp();
    let around = rectangle(center - (0.5 * size_m.y + ROOM_M) * across, along, size_m + 2.0 * ROOM_M);
    if !site.is_free(&around, 0.5, 0.5) {
        return false;
    }
    if is_hard {
        site.surface(&around, Surface::Asphalt);
        for [a, b] in edges(&around) {
            let step = (b - a).normalize();
            site.enclose(ThingKind::Fence, [a + 2.0 * step, b - 0.3 * step], 0.08, 3.0);
        }
    }
    let field = rectangle(center - 0.5 * size_m.y * across, along, size_m);
    let middle = [center - 0.5 * size_m.y * across, center + 0.5 * size_m.y * across];
    let circle = disc(center, 0.14 * size_m.y, 16);
    for [a, b] in edges(&field).chain([middle]).chain(edges(&circle)) {
        let step = (b - a).normalize();
        site.surface(&rectangle(a.lerp(b, 0.5), step, DVec2::new(a.distance(b), LINE_M)), Surface::Paint);
    }
    for end in [-1.0, 1.0] {
        let center = center + end * (0.5 * size_m.x + 0.6) * along;
        let lot = Lot { center, half_m: DVec2::new(0.5, 0.07 * size_m.y), heading_rad: real::atan2(along.y, along.x) };
        site.stand(ThingKind::Goal, lot, 2.0, 0.1);
    }
    site.take(&around);
    true
}

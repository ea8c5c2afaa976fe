//! Triangles of a body in the world: the entry to the figures of people and vehicles.

use crate::Clothes;
use crate::body_shape::BodyShape;
use crate::figure::person_on_foot;
use crate::frustum::FigureTriangle;
use crate::vehicles;
use crate::walker::Walker;
use cosfly_frames::DVec3;

/// Somebody's surface as bare triangles, for rays.
pub fn walker_triangles(walker: &Walker) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    figure(walker, &Clothes::draw(&walker.clothes_seed), 0, &mut triangles);
    triangles.iter().map(|triangle| triangle.corners_in_world).collect()
}

/// Appends the figure of `person` to `triangles`. All limbs stay near the upright cylinder of the walker; a vehicle stays
/// within its box.
pub fn figure(walker: &Walker, clothes: &Clothes, person: u32, triangles: &mut Vec<FigureTriangle>) {
    if !walker.has_body() {
        return;
    }
    if let BodyShape::Vehicle { kind, size_m } = walker.body {
        vehicles::add(walker, kind, size_m, clothes, person, triangles);
        return;
    }
    person_on_foot(walker, clothes, (person, 0), triangles);
}

//! Triangles of a body in the world: the entry to the figures of people and vehicles.

use crate::Clothes;
use crate::body_figure::BodyFigure;
use crate::body_shape::BodyShape;
use crate::frustum::FigureTriangle;
use crate::person::person_on_foot;
use crate::vehicles;
use cosfly_frames::DVec3;

/// Somebody's surface as bare triangles, for rays.
pub fn figure_triangles(figure: &BodyFigure) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    add_figure(figure, &Clothes::draw(&figure.clothes_seed), 0, &mut triangles);
    triangles.iter().map(|triangle| triangle.corners_in_world).collect()
}

/// Appends the figure of `person` to `triangles`. All limbs stay near the upright cylinder of the body; a vehicle stays
/// within its box.
pub fn add_figure(figure: &BodyFigure, clothes: &Clothes, person: u32, triangles: &mut Vec<FigureTriangle>) {
    if !figure.has_body() {
        return;
    }
    if let BodyShape::Vehicle { kind, size_m } = figure.body {
        vehicles::add(figure, kind, size_m, clothes, person, triangles);
        return;
    }
    person_on_foot(figure, clothes, (person, 0), triangles);
}

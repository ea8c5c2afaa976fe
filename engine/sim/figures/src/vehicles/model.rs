//! Flat faces of a vehicle's model, in the vehicle's own axes.

use crate::Clothes;
use crate::body_figure::BodyFigure;
use crate::frustum::{FigureTriangle, Surface, around};
use crate::person::person_on_foot;
use crate::region::Region;
use cosfly_frames::{DVec3, real};

/// Panels such as windows lie this far before the sheet, metres.
const PANEL_M: f64 = 0.004;
/// Sheet ends this far before both ends of the box, metres: lamps lie on it.
pub(super) const SHEET_M: f64 = 0.006;
/// Most corners of an outline.
const MOST_CORNERS: usize = 12;
/// Sides of a wheel.
pub(super) const SPOKES: usize = 12;

/// A vehicle while it is built. Own axes: x forward, y right, z up, metres, from the middle of the box's foot.
pub(super) struct Model<'a> {
    /// Length, width and height of the box, metres.
    pub size_m: DVec3,
    feet: DVec3,
    forward: DVec3,
    right: DVec3,
    person: u32,
    triangles: &'a mut Vec<FigureTriangle>,
}

impl<'a> Model<'a> {
    pub fn new(figure: &BodyFigure, size_m: DVec3, person: u32, triangles: &'a mut Vec<FigureTriangle>) -> Self {
        let (sin, cos) = real::sin_cos(figure.state.heading_rad);
        let (forward, right) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
        Self { size_m, feet: figure.state.feet_in_world, forward, right, person, triangles }
    }

    /// A flat convex face whose outside is away from `inside`; own axes, metres.
    pub fn face(&mut self, region: Region, corners: &[DVec3], inside: DVec3) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let outward = if normal.dot(corners[0] - inside) < 0.0 { -normal } else { normal };
        for pair in corners[1..].windows(2) {
            self.triangle(region, [corners[0], pair[0], pair[1]], outward, [outward; 3]);
        }
    }

    /// A triangle with its outward normal and those of the surface at its corners, unit length; own axes, metres.
    pub fn triangle(&mut self, region: Region, corners: [DVec3; 3], normal: DVec3, corner_normals: [DVec3; 3]) {
        let turned = |v: DVec3| self.forward * v.x + self.right * v.y + DVec3::Z * v.z;
        let triangle = FigureTriangle {
            corners_in_world: corners.map(|corner| self.feet + turned(corner)),
            normal_in_world: turned(normal),
            corner_normals: corner_normals.map(|normal| turned(normal).as_vec3().to_array()),
            middle_in_world: [self.feet; 2],
            region,
            person: self.person,
            // All faces of a region are shaded together.
            part: region as u32,
        };
        self.triangles.push(triangle);
    }

    /// A face of four corners with the normals of the surface there, outward; own axes, metres.
    pub fn round(&mut self, region: Region, corners: [(DVec3, DVec3); 4]) {
        for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
            let (points, normals) = ([i, j, k].map(|n| corners[n].0), [i, j, k].map(|n| corners[n].1));
            let flat = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or_zero();
            let outward = if flat.dot(normals[0]) < 0.0 { -flat } else { flat };
            self.triangle(region, points, outward, normals);
        }
    }

    /// A level panel: from and to shares of the length at a share of the height, over a share of the width either way.
    pub fn cross_top(&mut self, region: Region, [from, to]: [f64; 2], height: f64, half_width: f64) {
        let at = |x: f64, y: f64| self.size_m * DVec3::new(x, y, height);
        let corners = [at(from, -half_width), at(to, -half_width), at(to, half_width), at(from, half_width)];
        self.face(region, &corners, DVec3::ZERO);
    }

    /// A flat convex face before another one: moved away from `inside` by a few millimetres, but not out of the box.
    pub fn panel(&mut self, region: Region, corners: &[DVec3], inside: DVec3) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let outward = if normal.dot(corners[0] - inside) < 0.0 { -normal } else { normal };
        let (half, height_m) = (0.5 * self.size_m, self.size_m.z);
        let mut moved = [DVec3::ZERO; MOST_CORNERS];
        for (moved, corner) in moved.iter_mut().zip(corners) {
            *moved = *corner + PANEL_M * outward;
            *moved = moved.clamp(DVec3::new(-half.x, -half.y, 0.0), DVec3::new(half.x, half.y, height_m));
        }
        self.face(region, &moved[..corners.len().min(MOST_CORNERS)], inside);
    }

    /// A body whose side view is a convex outline of (x, z), as shares of length and height, and whose half width, as a
    /// share of the width, changes evenly from the foot of the box to its top.
    pub fn hull(&mut self, region: Region, outline: &[[f64; 2]], half_width: [f64; 2]) {
        let count = outline.len().min(MOST_CORNERS);
        let [mut left, mut right] = [[DVec3::ZERO; MOST_CORNERS]; 2];
        for (k, [x, z]) in outline.iter().enumerate().take(count) {
            (left[k], right[k]) = (self.point(*x, -1.0, *z, half_width), self.point(*x, 1.0, *z, half_width));
        }
        let (left, right) = (&left[..count], &right[..count]);
        let inside = left.iter().chain(right).sum::<DVec3>() / (2 * count) as f64;
        for k in 0..count {
            let next = (k + 1) % count;
            self.face(region, &[left[k], left[next], right[next], right[k]], inside);
        }
        self.face(region, left, inside);
        self.face(region, right, inside);
    }

    /// A point at shares (x, z) of length and height, and share `y` of the half width there.
    pub fn point(&self, x: f64, y: f64, z: f64, [foot, top]: [f64; 2]) -> DVec3 {
        let sheet_m = self.size_m - DVec3::X * (2.0 * SHEET_M);
        sheet_m * DVec3::new(x, y * (foot + (top - foot) * z), z)
    }

    /// A panel on both sides of a hull: an outline of (x, z).
    pub fn side_panels(&mut self, region: Region, outline: &[[f64; 2]], half_width: [f64; 2]) {
        for y in [-1.0, 1.0] {
            self.side_panel(region, outline, half_width, y);
        }
    }

    /// A panel on one side of a hull.
    pub fn side_panel(&mut self, region: Region, outline: &[[f64; 2]], half_width: [f64; 2], y: f64) {
        let mut corners = [DVec3::ZERO; MOST_CORNERS];
        for (corner, [x, z]) in corners.iter_mut().zip(outline) {
            *corner = self.point(*x, y, *z, half_width);
        }
        let inside = DVec3::new(corners[0].x, 0.0, corners[0].z);
        self.panel(region, &corners[..outline.len().min(MOST_CORNERS)], inside);
    }

    /// A panel across a face between two points of the side view, `(x, z)`, over `ys`, shares of the half width.
    pub fn cross_panel(&mut self, region: Region, [low, high]: [[f64; 2]; 2], ys: [f64; 2], half_width: [f64; 2]) {
        let at = |[x, z]: [f64; 2], y: f64| self.point(x, y, z, half_width);
        let corners = [at(low, ys[0]), at(low, ys[1]), at(high, ys[1]), at(high, ys[0])];
        self.panel(region, &corners, DVec3::new(0.0, 0.0, corners[0].z.min(corners[2].z)));
    }

    /// An open wheel in the middle plane: x of its middle, radius and width in metres; elliptic where the box is.
    pub fn spoked_wheel(&mut self, [x_m, y_m]: [f64; 2], radius_m: DVec3, width_m: f64) {
        let at = |share: f64, aside_m: f64| {
            rim(0.0, 1.0, share, y_m + aside_m).map(|p| DVec3::new(x_m + p.x * radius_m.x, p.y, radius_m.z * p.z))
        };
        let half_m = 0.5 * width_m;
        let rings = [at(1.0, -half_m), at(1.0, half_m), at(0.88, -half_m), at(0.88, half_m)];
        let middle = DVec3::new(x_m, y_m, radius_m.z);
        for k in 0..SPOKES {
            let next = (k + 1) % SPOKES;
            let [outer, outer_right, inner, inner_right] = &rings;
            self.face(Region::Tyre, &[outer[k], outer[next], outer_right[next], outer_right[k]], middle);
            self.face(Region::Tyre, &[outer[k], outer[next], inner[next], inner[k]], middle);
            self.face(Region::Tyre, &[outer_right[k], outer_right[next], inner_right[next], inner_right[k]], middle);
            // The inside of the rim looks to the hub.
            let beyond = 2.0 * inner[k] - middle;
            self.face(Region::Metal, &[inner[k], inner[next], inner_right[next], inner_right[k]], beyond);
        }
    }

    /// A wheel in the middle plane whose rim is closed.
    pub fn solid_wheel(&mut self, x_m: f64, radius_m: DVec3, width_m: f64) {
        let at = |share: f64, y_m: f64| {
            rim(0.0, 1.0, share, y_m).map(|p| DVec3::new(x_m + p.x * radius_m.x, p.y, radius_m.z * p.z))
        };
        let half_m = 0.5 * width_m;
        let middle = DVec3::new(x_m, 0.0, radius_m.z);
        let sides = [at(1.0, -half_m), at(1.0, half_m)];
        for k in 0..SPOKES {
            let next = (k + 1) % SPOKES;
            self.face(Region::Tyre, &[sides[0][k], sides[0][next], sides[1][next], sides[1][k]], middle);
        }
        for (side, sign) in sides.iter().zip([-1.0, 1.0]) {
            self.face(Region::Tyre, side, middle);
            self.face(Region::Metal, &at(0.66, sign * (half_m + PANEL_M)), middle);
            self.face(Region::Trim, &at(0.30, sign * (half_m + 2.0 * PANEL_M)), middle);
        }
    }

    /// A square bar between two points, metres.
    pub fn bar(&mut self, region: Region, from: DVec3, to: DVec3, thick_m: f64) {
        let along = (to - from).normalize_or_zero();
        let aside = if along.y.abs() < 0.9 { DVec3::Y } else { DVec3::X };
        let (u, v) = (0.5 * thick_m * aside, 0.5 * thick_m * along.cross(aside).normalize_or_zero());
        let corner = |end: DVec3, k: usize| end + [u + v, v - u, -u - v, u - v][k % 4];
        for k in 0..4 {
            let corners = [corner(from, k), corner(from, k + 1), corner(to, k + 1), corner(to, k)];
            self.face(region, &corners, 0.5 * (from + to));
        }
    }

    /// Appends the figure of a person on foot.
    pub fn on_foot(&mut self, figure: Option<BodyFigure>, clothes: &Clothes) {
        if let Some(figure) = figure {
            person_on_foot(&figure, clothes, (self.person, Region::COUNT as u32), self.triangles);
        }
    }

    /// Surface of a rider in shares of `canonical_m`, the size of the box around a vehicle whose rider is 1 box height tall.
    pub fn rider(&mut self, canonical_m: DVec3) -> Surface<'_> {
        let stretch = self.size_m / canonical_m;
        Surface {
            feet: self.feet,
            forward: self.forward * (stretch.x / stretch.z),
            right: self.right * (stretch.y / stretch.z),
            height: self.size_m.z,
            around: around(),
            person: self.person,
            // Beyond the regions, each of which is one part.
            parts: Region::COUNT as u32,
            triangles: self.triangles,
        }
    }
}

/// Corners of a wheel's rim, the first at the ground.
pub(super) fn rim(x_m: f64, radius_m: f64, share: f64, y_m: f64) -> [DVec3; SPOKES] {
    core::array::from_fn(|k| {
        let (sin, cos) = real::sin_cos(real::TAU * k as f64 / SPOKES as f64);
        DVec3::new(x_m + share * radius_m * sin, y_m, radius_m * (1.0 - share * cos))
    })
}

//! The plan of a whole town: ground, walkable ground and obstacles from above.

use cosfly_domain::{Obstacle, ObstacleKind, SemanticLabel, SurfaceMesh, Town, WalkableKind};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_plot::canvas::{Canvas, ChartColour, INK, Point, text_width};

/// Longest side of the drawn area, pixels.
const SIDE: f64 = 1400.0;
/// Most pixels per metre.
const DENSEST: f64 = 8.0;
/// Land around everything that stands or is walked on, metres.
const MARGIN_M: f64 = 20.0;
const HEADER: usize = 34;
const LEGEND: usize = 34;
/// Ground whose heights differ by less than this has no contour lines, metres; the most lines, and their distances, metres.
const LEAST_RELIEF_M: f64 = 4.0;
const MOST_CONTOURS: f64 = 16.0;
const CONTOURS_M: [f64; 8] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0];
const CONTOUR: ChartColour = [150, 104, 62];
const EMPTY: ChartColour = [244, 243, 240];

/// Colour over a place of a plan, and its share there.
pub type PlanShade = dyn Fn(DVec2) -> Option<(ChartColour, f64)>;

/// The plan of a town; north is up. `title` stands above it; `shade` colours places, under houses and trees.
pub fn town_plan(town: &Town, title: &str, shade: Option<&PlanShade>) -> Canvas {
    let view = View::of(town);
    let mut canvas = Canvas::new(view.size[0].max(700), view.size[1] + HEADER + LEGEND, EMPTY);
    // Land fills the picture: seams between its many triangles would show.
    let is_land = |mesh: &SurfaceMesh| layer(mesh.label) == 0;
    if town.surfaces.iter().any(is_land) {
        let size = [canvas.width as i64, view.size[1] as i64];
        canvas.fill([0, HEADER as i64], size, ground_colour(SemanticLabel::Terrain), 1.0);
    }
    let mut surfaces: Vec<&SurfaceMesh> = town.surfaces.iter().filter(|mesh| !is_land(mesh)).collect();
    surfaces.sort_by_key(|mesh| layer(mesh.label));
    for mesh in surfaces {
        draw_mesh(&view, &mut canvas, mesh);
    }
    for polygon in &town.walkable {
        let corners: Vec<Point> = polygon.outline_in_world.iter().map(|corner| view.place(corner.truncate())).collect();
        let colour = walkable_colour(polygon.kind);
        canvas.area(&corners, colour, 0.35);
        canvas.outline(&corners, 0.6, colour, 0.6);
    }
    let contour_m = contour_m(town);
    contour_m.into_iter().for_each(|step_m| draw_contours(&view, &mut canvas, town, step_m));
    if let Some(shade) = shade {
        draw_shade(&view, &mut canvas, shade);
    }
    let top_m = |it: &Obstacle| it.shape.center_in_world.z + it.shape.half_extents_m.z;
    let mut obstacles: Vec<&Obstacle> = town.obstacles.iter().collect();
    obstacles.sort_by(|a, b| top_m(a).total_cmp(&top_m(b)));
    let highest_m = obstacles.last().map_or(1.0, |it| it.shape.half_extents_m.z * 2.0).max(1.0);
    for obstacle in obstacles {
        draw_obstacle(&view, &mut canvas, obstacle, highest_m);
    }
    draw_frame(&view, &mut canvas, title, contour_m);
    canvas
}

/// World to picture: x to the right, y down.
struct View {
    low: DVec2,
    scale: f64,
    size: [usize; 2],
}

impl View {
    fn of(town: &Town) -> Self {
        let solid = town.obstacles.iter().map(|obstacle| obstacle.shape.bounds_in_world());
        let walked =
            town.walkable.iter().flat_map(|polygon| &polygon.outline_in_world).map(|corner| (*corner, *corner));
        let around = solid.chain(walked).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let bounds: (DVec3, DVec3) = (town.min_in_world, town.max_in_world);
        let (low, high) = around.map_or(bounds, |(low, high)| {
            (bounds.0.max(low - DVec3::splat(MARGIN_M)), bounds.1.min(high + DVec3::splat(MARGIN_M)))
        });
        let extent = (high - low).truncate().max(DVec2::splat(1.0));
        let scale = (SIDE / extent.max_element()).min(DENSEST);
        let size = (extent * scale).ceil().max(DVec2::ONE);
        Self { low: low.truncate(), scale, size: [size.x as usize, size.y as usize] }
    }

    fn place(&self, point: DVec2) -> Point {
        let place = (point - self.low) * self.scale;
        [place.x, HEADER as f64 + place.y]
    }
}

fn draw_mesh(view: &View, canvas: &mut Canvas, mesh: &SurfaceMesh) {
    let colour = ground_colour(mesh.label);
    for triangle in &mesh.triangles {
        let corners = triangle.map(|corner| view.place(mesh.vertices_in_world[corner as usize].truncate()));
        canvas.area(&corners, colour, 1.0);
    }
}

/// The terrain, also where it is bare; not the patches on it.
fn land(town: &Town) -> impl Iterator<Item = &SurfaceMesh> {
    let is_land = |mesh: &&SurfaceMesh| layer(mesh.label) == 0 || layer(mesh.label) == 1 && mesh.synthetic;
    town.surfaces.iter().filter(is_land)
}

/// Distance in height of the contour lines of a town with relief, metres.
fn contour_m(town: &Town) -> Option<f64> {
    let heights = land(town).flat_map(|mesh| &mesh.vertices_in_world).map(|corner| corner.z);
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| [low.min(z), high.max(z)]);
    let is_wide_enough = |step_m: &f64| high - low <= MOST_CONTOURS * step_m;
    CONTOURS_M.into_iter().find(is_wide_enough).filter(|_| high - low >= LEAST_RELIEF_M)
}

fn draw_contours(view: &View, canvas: &mut Canvas, town: &Town, step_m: f64) {
    for (mesh, triangle) in land(town).flat_map(|mesh| mesh.triangles.iter().map(move |triangle| (mesh, triangle))) {
        let corners = triangle.map(|corner| mesh.vertices_in_world[corner as usize]);
        let [low, high] = [f64::min, f64::max].map(|pick| corners.map(|it| it.z / step_m).into_iter().reduce(pick));
        for level in low.unwrap_or(0.0).ceil() as i64..=high.unwrap_or(0.0).floor() as i64 {
            let z = level as f64 * step_m;
            let sides = [0, 1, 2].map(|side| [corners[side], corners[(side + 1) % 3]]);
            let crossed = sides.into_iter().filter(|[a, b]| (a.z < z) != (b.z < z));
            let ends: Vec<Point> =
                crossed.map(|[a, b]| view.place(a.lerp(b, (z - a.z) / (b.z - a.z)).truncate())).collect();
            if let [from, to] = ends[..] {
                canvas.line(from, to, 1.0, CONTOUR, 0.7);
            }
        }
    }
}

fn draw_shade(view: &View, canvas: &mut Canvas, shade: &PlanShade) {
    for row in 0..view.size[1] {
        for column in 0..view.size[0] {
            let point = view.low + DVec2::new(column as f64 + 0.5, row as f64 + 0.5) / view.scale;
            if let Some((colour, share)) = shade(point) {
                canvas.blend(column as i64, (HEADER + row) as i64, colour, share);
            }
        }
    }
}

/// A box from above; high ones are darker.
fn draw_obstacle(view: &View, canvas: &mut Canvas, obstacle: &Obstacle, highest_m: f64) {
    let shape = &obstacle.shape;
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[a, b]| {
        let (along, across) = (a * shape.half_extents_m.x, b * shape.half_extents_m.y);
        let offset = DVec2::new(along * cos - across * sin, along * sin + across * cos);
        view.place(shape.center_in_world.truncate() + offset)
    });
    let (colour, share) = match obstacle.kind {
        ObstacleKind::Building | ObstacleKind::Bridge => {
            let height = (2.0 * shape.half_extents_m.z / highest_m).clamp(0.0, 1.0).sqrt();
            ([198, 170, 148].map(|value| (f64::from(value) * (1.0 - 0.55 * height)) as u8), 1.0)
        }
        ObstacleKind::TreeCrown | ObstacleKind::Bush => ([96, 146, 78], 0.55),
        ObstacleKind::TreeTrunk => ([86, 70, 52], 0.9),
        ObstacleKind::Wall | ObstacleKind::Fence | ObstacleKind::GuardRail => ([110, 92, 84], 0.9),
        _ => ([60, 70, 110], 0.9),
    };
    canvas.area(&corners, colour, share);
}

/// Order in which ground is drawn.
fn layer(label: SemanticLabel) -> u8 {
    match label {
        SemanticLabel::Terrain => 0,
        SemanticLabel::Ground => 1,
        SemanticLabel::Water => 2,
        SemanticLabel::Roads => 3,
        SemanticLabel::SideWalks => 4,
        _ => 5,
    }
}

fn ground_colour(label: SemanticLabel) -> ChartColour {
    match label {
        SemanticLabel::Terrain => [206, 218, 186],
        SemanticLabel::Ground => [226, 214, 188],
        SemanticLabel::Water => [158, 196, 224],
        SemanticLabel::Roads => [150, 152, 158],
        SemanticLabel::SideWalks => [222, 218, 212],
        SemanticLabel::RoadLine => [240, 240, 236],
        _ => [190, 188, 182],
    }
}

fn walkable_colour(kind: WalkableKind) -> ChartColour {
    match kind {
        WalkableKind::Sidewalk | WalkableKind::Shoulder => [70, 60, 200],
        WalkableKind::Crossing => [220, 60, 60],
        WalkableKind::Plaza => [200, 150, 40],
        WalkableKind::Road => [110, 110, 120],
    }
}

/// Title above; legend and scale below.
fn draw_frame(view: &View, canvas: &mut Canvas, title: &str, contour_m: Option<f64>) {
    let (width, bottom) = (canvas.width as i64, (canvas.height - LEGEND) as i64);
    canvas.fill([0, 0], [width, HEADER as i64], EMPTY, 1.0);
    canvas.fill([0, bottom], [width, LEGEND as i64], EMPTY, 1.0);
    canvas.text(8, 10, 2, INK, title);
    let y = bottom + 14;
    let legend = [
        ("pavement", walkable_colour(WalkableKind::Sidewalk)),
        ("crossing", walkable_colour(WalkableKind::Crossing)),
        ("plaza", walkable_colour(WalkableKind::Plaza)),
        ("road", ground_colour(SemanticLabel::Roads)),
        ("bare", ground_colour(SemanticLabel::Ground)),
        ("water", ground_colour(SemanticLabel::Water)),
        ("house (dark: high)", [198, 170, 148]),
        ("plants", [96, 146, 78]),
    ];
    let mut x = 8;
    for (words, colour) in legend {
        canvas.fill([x, y - 1], [14, 9], colour, 1.0);
        x = canvas.text(x + 18, y, 1, INK, words) + 8;
    }
    if let Some(step_m) = contour_m {
        canvas.fill([x, y + 3], [14, 1], CONTOUR, 1.0);
        canvas.text(x + 18, y, 1, INK, &format!("every {step_m} m of height"));
    }
    let wanted_m = 120.0 / view.scale;
    let power = 10_f64.powi(wanted_m.log10().floor() as i32);
    let length_m = [5.0, 2.0, 1.0].into_iter().map(|step| step * power).find(|it| *it <= wanted_m).unwrap_or(power);
    let words = format!("{length_m} m");
    let end = (width - 12 - text_width(&words, 1)) as f64;
    canvas.line([end - length_m * view.scale, y as f64 + 3.0], [end - 4.0, y as f64 + 3.0], 2.0, INK, 1.0);
    canvas.text(end as i64, y, 1, INK, &words);
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::WalkablePolygon;

    #[test]
    fn land_with_relief_has_contour_lines_and_level_land_has_none() {
        let plan = |rise_m: f64| {
            let corners = [(0.0, 0.0, 0.0), (40.0, 0.0, rise_m), (40.0, 40.0, rise_m), (0.0, 40.0, 0.0)];
            let land = SurfaceMesh {
                label: SemanticLabel::Terrain,
                vertices_in_world: corners.map(DVec3::from).to_vec(),
                along_across_m: vec![],
                triangles: vec![[0, 1, 2], [0, 2, 3]],
                synthetic: true,
            };
            let (min_in_world, max_in_world) = (DVec3::ZERO, DVec3::new(40.0, 40.0, 1.0));
            let town = Town { surfaces: vec![land], min_in_world, max_in_world, ..Town::default() };
            let (plan, view) = (town_plan(&town, "slope", None), View::of(&town));
            [20.0, 22.0].map(|x| {
                let [x, y] = view.place(DVec2::new(x, 13.0));
                plan.pixel(x as usize, y as usize)
            })
        };
        // Every metre of height, one line each 4 m.
        let [line, land] = plan(10.0);
        assert_eq!(land, ground_colour(SemanticLabel::Terrain));
        assert_ne!(line, land);
        assert_eq!(plan(1.0), [land; 2]);
    }

    #[test]
    fn pavements_that_bend_are_filled_along_both_arms_and_not_between_them() {
        let bend = [(0.0, 0.0), (40.0, 0.0), (40.0, 4.0), (10.0, 6.0), (6.0, 10.0), (4.0, 40.0), (0.0, 40.0)];
        let outline_in_world = bend.map(|(x, y)| DVec3::new(x, y, 0.15)).to_vec();
        let walkable = vec![WalkablePolygon { kind: WalkableKind::Sidewalk, outline_in_world, synthetic: false }];
        let (min_in_world, max_in_world) = (DVec3::ZERO, DVec3::new(40.0, 40.0, 1.0));
        let town = Town { walkable, min_in_world, max_in_world, ..Town::default() };
        let (plan, view) = (town_plan(&town, "bend", None), View::of(&town));
        let at = |x: f64, y: f64| {
            let [x, y] = view.place(DVec2::new(x, y));
            plan.pixel(x as usize, y as usize)
        };
        let filled = at(1.5, 1.5);
        assert_ne!(filled, EMPTY);
        for (x, y) in [(38.0, 2.0), (25.0, 2.0), (2.0, 25.0), (2.0, 38.0), (7.0, 7.0)] {
            assert_eq!(at(x, y), filled, "{x} {y}");
        }
        assert_eq!(at(25.0, 25.0), EMPTY);
    }
}

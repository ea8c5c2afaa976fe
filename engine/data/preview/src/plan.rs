//! The plan: town, walk and flights from above, the flights coloured by how much of the target is visible.

use crate::clip::ramp;
use crate::ground::SeenGround;
use cosfly_diagnose::counted;
use cosfly_frames::{DVec3, real};
use cosfly_plot::canvas::{Canvas, ChartColour, INK, Point, WHITE, text_width};
use cosfly_read::{FrameRow, LoggedBox, PublishedFlight};

/// Longest side of the drawn area, pixels.
const SIDE: f64 = 1280.0;
/// Most pixels per metre, so that short flights do not fill the sheet with one wall.
const DENSEST: f64 = 16.0;
/// Margin around the flights, metres.
const MARGIN_M: f64 = 14.0;
/// Smallest extent, metres.
const SMALLEST_M: f64 = 60.0;
const HEADER: usize = 34;
const LEGEND: usize = 34;
/// Lines of sight that are drawn.
const SIGHTS: usize = 9;
const WALK: ChartColour = [70, 60, 200];

/// Content of a plan.
pub struct Plan<'a> {
    /// The chosen flight.
    pub flight: &'a PublishedFlight,
    /// The expert and its twins with their frames, the expert first.
    pub family: Vec<(&'a PublishedFlight, Vec<FrameRow>)>,
    /// Obstacles near the flight.
    pub boxes: Vec<LoggedBox>,
    /// The ground.
    pub ground: SeenGround,
}

/// Projection of the world to the picture: x to the right, y down, as seen from above.
struct View {
    low: [f64; 2],
    scale: f64,
    size: [usize; 2],
}

impl View {
    fn over(points: impl Iterator<Item = DVec3>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for (axis, value) in [point.x, point.y].into_iter().enumerate() {
                low[axis] = low[axis].min(value - MARGIN_M);
                high[axis] = high[axis].max(value + MARGIN_M);
            }
        }
        for axis in 0..2 {
            let short = (SMALLEST_M - (high[axis] - low[axis])).max(0.0);
            low[axis] -= 0.5 * short;
            high[axis] += 0.5 * short;
        }
        let extent = [high[0] - low[0], high[1] - low[1]];
        let scale = (SIDE / extent[0].max(extent[1])).min(DENSEST);
        Self { low, scale, size: extent.map(|side| (side * scale).ceil() as usize) }
    }

    fn of(&self, x_m: f64, y_m: f64) -> Point {
        [(x_m - self.low[0]) * self.scale, HEADER as f64 + (y_m - self.low[1]) * self.scale]
    }
}

impl Plan<'_> {
    /// The picture.
    pub fn draw(&self) -> Canvas {
        let frames = self.family.iter().flat_map(|(_, frames)| frames);
        let view = View::over(frames.flat_map(|frame| [frame.pose.position_in_world, frame.target.feet_in_world]));
        let mut canvas = Canvas::new(view.size[0].max(620), view.size[1] + HEADER + LEGEND, [228, 227, 222]);
        self.draw_ground(&view, &mut canvas);
        self.draw_boxes(&view, &mut canvas);
        self.draw_walk(&view, &mut canvas);
        for (place, (_, frames)) in self.family.iter().enumerate().rev() {
            draw_flight(&view, &mut canvas, frames, place == 0);
        }
        self.draw_sights(&view, &mut canvas);
        self.draw_frame(&view, &mut canvas);
        canvas
    }

    fn draw_ground(&self, view: &View, canvas: &mut Canvas) {
        for row in 0..view.size[1] {
            let y_m = view.low[1] + (row as f64 + 0.5) / view.scale;
            for column in 0..view.size[0] {
                let x_m = view.low[0] + (column as f64 + 0.5) / view.scale;
                if let Some(colour) = self.ground.colour_at(x_m, y_m) {
                    canvas.blend(column as i64, (row + HEADER) as i64, colour, 1.0);
                }
            }
        }
    }

    /// Low boxes first, so that roofs lie above awnings.
    fn draw_boxes(&self, view: &View, canvas: &mut Canvas) {
        let top = |it: &LoggedBox| it.center_in_map.z + it.half_extents_m.z;
        let mut boxes: Vec<&LoggedBox> = self.boxes.iter().collect();
        boxes.sort_by(|a, b| top(a).total_cmp(&top(b)));
        for it in boxes {
            let (sin, cos) = real::sin_cos(it.yaw_rad);
            let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[a, b]| {
                let (along, across) = (a * it.half_extents_m.x, b * it.half_extents_m.y);
                let (x, y) = (along * cos - across * sin, along * sin + across * cos);
                view.of(it.center_in_map.x + x, -(it.center_in_map.y + y))
            });
            let (fill, share) = match it.label.as_str() {
                "Building" => ([176, 158, 146], 0.94),
                "Vegetation" => ([96, 146, 78], 0.5),
                "Wall" | "Fence" | "GuardRail" => ([140, 128, 120], 0.9),
                _ => ([120, 126, 140], 0.8),
            };
            canvas.area(&corners, fill, share);
            canvas.outline(&corners, 1.0, fill.map(|value| value / 2), 0.5);
        }
    }

    fn draw_walk(&self, view: &View, canvas: &mut Canvas) {
        let Some((_, frames)) = self.family.first() else { return };
        let places: Vec<Point> =
            frames.iter().map(|it| view.of(it.target.feet_in_world.x, it.target.feet_in_world.y)).collect();
        for pair in places.windows(2) {
            canvas.line(pair[0], pair[1], 5.5, WHITE, 1.0);
        }
        for pair in places.windows(2) {
            canvas.line(pair[0], pair[1], 3.0, WALK, 1.0);
        }
        if let (Some(first), Some(last)) = (places.first(), places.last()) {
            mark(canvas, *first, "start", WALK);
            mark(canvas, *last, "end", WALK);
        }
    }

    /// Numbered lines of sight from drone to target.
    fn draw_sights(&self, view: &View, canvas: &mut Canvas) {
        let Some((_, frames)) = self.family.iter().find(|(flight, _)| *flight == self.flight) else { return };
        for number in crate::selection::spread(frames.len(), SIGHTS) {
            let frame = &frames[number];
            let drone = view.of(frame.pose.position_in_world.x, frame.pose.position_in_world.y);
            let target = view.of(frame.target.feet_in_world.x, frame.target.feet_in_world.y);
            canvas.line(drone, target, 1.0, INK, 0.55);
            canvas.disc(target, 3.0, WALK);
            canvas.disc(drone, 5.0, INK);
            canvas.disc(drone, 3.5, ramp(frame.visible_by_rays));
            canvas.label(drone[0] as i64 + 6, drone[1] as i64 - 12, 1, WHITE, &number.to_string());
        }
    }

    /// Title above, legend and scale below.
    fn draw_frame(&self, view: &View, canvas: &mut Canvas) {
        let (width, bottom) = (canvas.width as i64, (canvas.height - LEGEND) as i64);
        canvas.fill([0, 0], [width, HEADER as i64], [244, 243, 240], 1.0);
        canvas.fill([0, bottom], [width, LEGEND as i64], [244, 243, 240], 1.0);
        let end = canvas.text(8, 10, 2, INK, &self.flight.trajectory_id);
        let twins = match self.family.len().saturating_sub(1) {
            0 => String::new(),
            twins => format!("  (thick: expert; thin: perturbed, {twins})"),
        };
        let seen: f64 = self.family.iter().filter(|(flight, _)| *flight == self.flight).map(|(_, it)| mean(it)).sum();
        let about = format!(
            "{}  {}, {:.1} s  visible {:.0} %{twins}",
            self.flight.town,
            counted(self.flight.frames, "frame"),
            self.flight.frames.saturating_sub(1) as f64 * self.flight.dt_s,
            100.0 * seen
        );
        canvas.text(end + 14, 14, 1, [90, 92, 96], &about);
        let y = bottom + 14;
        let mut x = canvas.text(8, y, 1, INK, "visible 0 ");
        for step in 0..40 {
            canvas.fill([x + 3 * step, y - 1], [3, 9], ramp(step as f64 / 39.0), 1.0);
        }
        x = canvas.text(x + 126, y, 1, INK, "100 %");
        canvas.line([(x + 20) as f64, (y + 3) as f64], [(x + 46) as f64, (y + 3) as f64], 3.0, WALK, 1.0);
        canvas.text(x + 54, y, 1, INK, "way of the target");
        scale_bar(view, canvas, y);
    }
}

fn mean(frames: &[FrameRow]) -> f64 {
    frames.iter().map(|frame| frame.visible_by_rays).sum::<f64>() / frames.len().max(1) as f64
}

fn draw_flight(view: &View, canvas: &mut Canvas, frames: &[FrameRow], is_expert: bool) {
    let (casing, thickness) = if is_expert { (6.0, 4.0) } else { (3.6, 2.2) };
    let place = |frame: &FrameRow| view.of(frame.pose.position_in_world.x, frame.pose.position_in_world.y);
    for pair in frames.windows(2) {
        canvas.line(place(&pair[0]), place(&pair[1]), casing, INK, 1.0);
    }
    for pair in frames.windows(2) {
        let visible = 0.5 * (pair[0].visible_by_rays + pair[1].visible_by_rays);
        canvas.line(place(&pair[0]), place(&pair[1]), thickness, ramp(visible), 1.0);
    }
}

fn mark(canvas: &mut Canvas, at: Point, words: &str, colour: ChartColour) {
    canvas.disc(at, 6.0, WHITE);
    canvas.disc(at, 4.5, colour);
    canvas.label(at[0] as i64 + 8, at[1] as i64 + 4, 1, WHITE, words);
}

/// A bar of a round length in the lower right corner; north is up, because y points south.
fn scale_bar(view: &View, canvas: &mut Canvas, y: i64) {
    let metres = [100.0, 50.0, 20.0, 10.0, 5.0].into_iter().find(|it| it * view.scale < 180.0).unwrap_or(5.0);
    let words = format!("{metres} m, north is up");
    let right = canvas.width as i64 - 10 - text_width(&words, 1);
    canvas.text(right, y, 1, INK, &words);
    let length = (metres * view.scale) as i64;
    canvas.fill([right - 10 - length, y + 2], [length, 3], INK, 1.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_hold_every_point_and_are_neither_endless_nor_tiny() {
        let one = View::over([DVec3::new(5.0, -3.0, 1.0)].into_iter());
        assert_eq!((one.scale, one.size), (DENSEST, [960, 960]));
        let far = View::over([DVec3::ZERO, DVec3::new(4000.0, 100.0, 0.0)].into_iter());
        assert!(far.size[0] <= 1281 && far.size[1] <= 200);
        let corner = far.of(4000.0, 100.0);
        assert!(corner[0] < far.size[0] as f64 && corner[1] < (far.size[1] + HEADER) as f64);
    }
}

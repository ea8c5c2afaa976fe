//! Pictures of one path: a plan view of every flight, coloured by visibility, and the cost by iteration.

use super::figures::Flight;
use super::scene::Ground;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, DVec3, TargetTrack, real};
use cosfly_plot::document::{Anchor, Document};

/// Width of one plan view, pixels.
const VIEW_PX: f64 = 460.0;
/// Margin of ground around the paths, metres.
const MARGIN_M: f64 = 12.0;
/// Height of the title above a view, pixels.
const TITLE_PX: f64 = 44.0;
/// Plan views side by side.
const VIEWS_PER_ROW: usize = 4;
/// Largest width of the chart of costs, pixels.
const CHART_WIDTH_PX: f64 = 900.0;
/// Height of the chart of costs, pixels.
const CHART_PX: f64 = 220.0;
/// Colour scale of visibility, 0 to 1.
const SCALE: [(f64, [f64; 3]); 4] =
    [(0.0, [165.0, 0.0, 38.0]), (0.5, [244.0, 109.0, 67.0]), (0.85, [217.0, 180.0, 40.0]), (1.0, [26.0, 152.0, 80.0])];

/// Colour of a visibility.
fn colour(visibility: f64) -> String {
    let above = SCALE.iter().position(|(at, _)| visibility <= *at).unwrap_or(SCALE.len() - 1).max(1);
    let ((low, from), (high, to)) = (SCALE[above - 1], SCALE[above]);
    let share = ((visibility - low) / (high - low)).clamp(0.0, 1.0);
    let mix = |k: usize| (from[k] + share * (to[k] - from[k])).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

/// Projection from metres on the map to pixels of a view.
struct Projection {
    low: DVec2,
    scale: f64,
    left: f64,
    bottom: f64,
}

impl Projection {
    fn at(&self, point: DVec2) -> (f64, f64) {
        let from_low = self.scale * (point - self.low);
        (self.left + from_low.x, self.bottom - from_low.y)
    }

    fn of(&self, point: DVec3) -> (f64, f64) {
        self.at(point.truncate())
    }
}

/// Picture of one path: a plan view per flight, and below them the costs of planners with a solver.
pub fn picture(ground: &Ground, path: usize, flights: &[(&str, &Flight)]) -> String {
    let track = &ground.tracks[path];
    let (low, high) = extent(track, flights);
    let scale = VIEW_PX / (high - low).max_element().max(1.0);
    let (width, height) = (scale * (high.x - low.x), scale * (high.y - low.y));
    let gap = 16.0;
    let (column, row) = (width.max(250.0) + gap, TITLE_PX + height);
    let columns = flights.len().clamp(1, VIEWS_PER_ROW);
    let views_px = row * flights.len().div_ceil(columns) as f64;
    let solvers: Vec<&(&str, &Flight)> = flights.iter().filter(|(_, flight)| flight.convergence.len() > 1).collect();
    let chart_px = if solvers.is_empty() { 0.0 } else { CHART_PX };
    let total = (gap + columns as f64 * column).max(560.0);
    let title = format!("Flights over walk {path} of {}", ground.name);
    let mut page = Document::new(&title, total, views_px + 30.0 + chart_px);
    for (index, (name, flight)) in flights.iter().enumerate() {
        let (left, top) = (gap + (index % columns) as f64 * column, (index / columns) as f64 * row);
        let view = Projection { low, scale, left, bottom: top + row };
        titles(&mut page, (left, top), name, flight);
        page.begin_clip(&format!("view{index}"), (left, top + TITLE_PX), (width, height));
        page.rectangle((left, top + TITLE_PX), (width, height), "#f4f4f2", 1.0);
        ground.planning_boxes.iter().for_each(|shape| footprint(&mut page, &view, shape, low, high));
        walk(&mut page, &view, track);
        flown(&mut page, &view, flight);
        page.end_clip();
    }
    legend(&mut page, gap, views_px + 18.0, scale);
    if chart_px > 0.0 {
        chart(&mut page, gap, views_px + 40.0, (total - 2.0 * gap).min(CHART_WIDTH_PX), &solvers);
    }
    page.finish()
}

fn extent(track: &TargetTrack, flights: &[(&str, &Flight)]) -> (DVec2, DVec2) {
    let feet = track.states.iter().map(|state| state.feet_in_world.truncate());
    let flown = flights.iter().flat_map(|(_, flight)| flight.waypoints.iter().map(|w| w.truncate()));
    let (low, high) = feet
        .chain(flown)
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)));
    (low - DVec2::splat(MARGIN_M), high + DVec2::splat(MARGIN_M))
}

fn titles(page: &mut Document, (left, top): (f64, f64), name: &str, flight: &Flight) {
    page.words((left, top + 18.0), name, Anchor::Start, "#111111");
    let words = match &flight.figures {
        Ok(figures) => {
            format!("visibility {:.3}, {:.0} m, {:.1} ms", figures.visibility, figures.length_m, 1e3 * flight.cpu_s)
        }
        Err(_) => "no flight".to_owned(),
    };
    page.words((left, top + 35.0), &words, Anchor::Start, "#555555");
}

/// Obstacles from above; higher ones are darker.
fn footprint(page: &mut Document, view: &Projection, shape: &OrientedBox, low: DVec2, high: DVec2) {
    let (min, max) = shape.bounds_in_world();
    if min.x > high.x || min.y > high.y || max.x < low.x || max.y < low.y {
        return;
    }
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let corner = |x: f64, y: f64| {
        let (x, y) = (x * shape.half_extents_m.x, y * shape.half_extents_m.y);
        view.at(shape.center_in_world.truncate() + DVec2::new(cos * x - sin * y, sin * x + cos * y))
    };
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    page.polygon(&corners, "#5b6770", (0.2 + 0.015 * max.z).clamp(0.2, 0.75));
}

fn walk(page: &mut Document, view: &Projection, track: &TargetTrack) {
    let feet: Vec<(f64, f64)> = track.states.iter().map(|state| view.of(state.feet_in_world)).collect();
    page.line(&feet, "#1f3b73", 1.6, "5 4");
    if let Some(&first) = feet.first() {
        page.disc(first, 3.5, "#1f3b73");
    }
}

/// Flight in segments of one colour.
fn flown(page: &mut Document, view: &Projection, flight: &Flight) {
    let mut run: Vec<(f64, f64)> = Vec::new();
    let mut shade = String::new();
    for (pair, visibility) in flight.waypoints.windows(2).zip(&flight.visibility) {
        let now = colour(*visibility);
        if now != shade {
            if run.len() > 1 {
                page.line(&run, &shade, 3.0, "");
            }
            run = vec![view.of(pair[0])];
            shade = now;
        }
        run.push(view.of(pair[1]));
    }
    if run.len() > 1 {
        page.line(&run, &shade, 3.0, "");
    }
    if let Some(&first) = flight.waypoints.first() {
        page.disc(view.of(first), 4.5, "#111111");
    }
}

fn legend(page: &mut Document, left: f64, y: f64, scale: f64) {
    let words = ["0", "1/2", "all seen"];
    let mut x = left;
    for (value, word) in [0.0, 0.5, 1.0].iter().zip(words) {
        page.line(&[(x, y - 4.0), (x + 24.0, y - 4.0)], &colour(*value), 3.0, "");
        page.words((x + 30.0, y), word, Anchor::Start, "#333333");
        x += 70.0 + 12.0 * f64::from(u8::from(word.len() > 3));
    }
    page.line(&[(x + 20.0, y - 4.0), (x + 44.0, y - 4.0)], "#1f3b73", 1.6, "5 4");
    page.words((x + 50.0, y), "walker", Anchor::Start, "#333333");
    page.line(&[(x + 110.0, y - 4.0), (x + 110.0 + 20.0 * scale, y - 4.0)], "#111111", 2.0, "");
    page.words((x + 116.0 + 20.0 * scale, y), "20 m", Anchor::Start, "#333333");
}

/// Cost by iteration, one colour per solver, on a logarithmic scale.
fn chart(page: &mut Document, left: f64, top: f64, width: f64, solvers: &[&(&str, &Flight)]) {
    let (plot_left, plot_width, plot_height) = (left + 60.0, width - 180.0, CHART_PX - 70.0);
    let costs = || solvers.iter().flat_map(|(_, flight)| flight.convergence.iter().copied()).filter(|c| *c > 0.0);
    let (low, high) = costs().fold((f64::INFINITY, 0.0_f64), |(low, high), cost| (low.min(cost), high.max(cost)));
    if high <= 0.0 {
        return;
    }
    let steps = solvers.iter().map(|(_, flight)| flight.convergence.len()).max().unwrap_or(2) - 1;
    let (log_low, log_high) = (real::ln(low) - 0.05, real::ln(high) + 0.05);
    let at = |step: usize, cost: f64| {
        let x = plot_left + plot_width * step as f64 / steps as f64;
        let share = (real::ln(cost.max(low)) - log_low) / (log_high - log_low);
        (x, top + plot_height * (1.0 - share))
    };
    page.rectangle((plot_left, top), (plot_width, plot_height), "#f4f4f2", 1.0);
    for cost in [low, (low * high).sqrt(), high] {
        let (_, y) = at(0, cost);
        page.line(&[(plot_left, y), (plot_left + plot_width, y)], "#d0d0d0", 0.8, "");
        page.words((plot_left - 6.0, y + 4.0), &format!("{cost:.0}"), Anchor::End, "#555555");
    }
    for step in [0, steps] {
        page.words((at(step, low).0, top + plot_height + 16.0), &step.to_string(), Anchor::Middle, "#555555");
    }
    let middle = plot_left + 0.5 * plot_width;
    page.words((middle, top + plot_height + 16.0), "total cost by iteration", Anchor::Middle, "#333333");
    for ((name, flight), shade) in solvers.iter().zip(["#1b6ca8", "#c2571a", "#3a7d44", "#7a3b8f"].iter().cycle()) {
        let line: Vec<(f64, f64)> = flight.convergence.iter().enumerate().map(|(i, &cost)| at(i, cost)).collect();
        page.line(&line, shade, 1.8, "");
        if let Some(&(x, y)) = line.last() {
            page.words((x + 6.0, y + 4.0), name, Anchor::Start, shade);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_run_from_red_to_green() {
        assert_eq!(colour(0.0), "#a50026");
        assert_eq!(colour(1.0), "#1a9850");
        assert_eq!(colour(0.25), "#cd3735");
    }
}

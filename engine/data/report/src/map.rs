//! A town from above with its flights, coloured by how much of their targets they see.

use crate::model::{BoxSketch, TownSketch};
use crate::moments;
use crate::sketch::FlightSketch;
use cosfly_diagnose::counted;
use cosfly_plot::statistics;
use cosfly_plot::strip::class_of;
use cosfly_plot::text::escaped;
use std::collections::BTreeMap;
use std::fmt::Write;

const WIDTH: f64 = 1000.0;
/// Smallest and largest height, pixels.
const HEIGHTS: (f64, f64) = (380.0, 760.0);
/// Margin around the flights, metres.
const MARGIN_M: f64 = 18.0;
/// Largest number of flights in a map.
const MOST_FLIGHTS: usize = 40;
/// Largest number of boxes of one kind in a map.
const MOST_BOXES: usize = 6_000;

/// A figure of `town` with some of its `all` flights, experts' where there are some; empty without flights.
pub fn draw(town: &TownSketch, flights: &[&FlightSketch], all: u64) -> String {
    let experts: Vec<&FlightSketch> = flights.iter().filter(|it| !it.is_perturbed).copied().collect();
    let (drawn, role) = if experts.is_empty() { (flights.to_vec(), "perturbed") } else { (experts, "expert") };
    let chosen: Vec<&FlightSketch> =
        moments::spread(drawn.len(), MOST_FLIGHTS).into_iter().map(|at| drawn[at]).collect();
    let Some(sheet) = Sheet::around(&chosen) else { return String::new() };
    let name = format!(
        "Map of {} with {}, coloured by visibility of their targets; north is up",
        town.name,
        counted(chosen.len(), "flight")
    );
    let mut svg = format!(
        "<svg viewBox=\"0 0 {WIDTH} {:.0}\" role=\"img\" aria-label=\"{}\"><rect class=\"land\" width=\"100%\" height=\"100%\"/>",
        sheet.height,
        escaped(&name)
    );
    sheet.obstacles(&mut svg, &town.boxes);
    chosen.iter().for_each(|flight| sheet.walk(&mut svg, flight));
    chosen.iter().for_each(|flight| sheet.flight(&mut svg, flight));
    sheet.scale_bar(&mut svg);
    svg.push_str("</svg>");
    let shown = match (chosen.len() as u64, all.max(chosen.len() as u64)) {
        (some, all) if some < all => format!("{some} of {}", counted(all, &format!("{role} flight"))),
        (all, _) => counted(all, &format!("{role} flight")),
    };
    let mean = chosen.iter().map(|flight| flight.mean_visible()).sum::<f64>() / chosen.len() as f64;
    format!(
        "<figure class=\"card wide\"><h3>{}</h3>{svg}<figcaption>{shown}; on average {:.1} % of the target is visible. \
         Dots: start of each flight. Dashed: the way of the target.</figcaption></figure>",
        escaped(&town.name),
        100.0 * mean
    )
}

/// Projection from metres to pixels.
struct Sheet {
    west_m: f64,
    north_m: f64,
    px_per_m: f64,
    height: f64,
}

impl Sheet {
    fn around(flights: &[&FlightSketch]) -> Option<Self> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for place in flights.iter().flat_map(|flight| flight.drone_m.iter().chain(&flight.feet_m)) {
            for axis in 0..2 {
                low[axis] = low[axis].min(f64::from(place[axis]) - MARGIN_M);
                high[axis] = high[axis].max(f64::from(place[axis]) + MARGIN_M);
            }
        }
        let (wide, deep) = (high[0] - low[0], high[1] - low[1]);
        if !(wide.is_finite() && deep.is_finite() && wide > 0.0) {
            return None;
        }
        let height = (WIDTH * deep / wide).clamp(HEIGHTS.0, HEIGHTS.1);
        let px_per_m = (WIDTH / wide).min(height / deep);
        let west_m = low[0] - 0.5 * (WIDTH / px_per_m - wide);
        Some(Self { west_m, north_m: low[1] - 0.5 * (height / px_per_m - deep), px_per_m, height })
    }

    fn px(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.west_m) * self.px_per_m, (y - self.north_m) * self.px_per_m]
    }

    fn is_inside(&self, [x, y]: [f64; 2], reach_m: f64) -> bool {
        let reach = reach_m * self.px_per_m;
        x > -reach && x < WIDTH + reach && y > -reach && y < self.height + reach
    }

    /// Crowns of trees as discs, all else as the shapes of the boxes.
    fn obstacles(&self, svg: &mut String, boxes: &[BoxSketch]) {
        let mut shapes: BTreeMap<&str, Vec<&BoxSketch>> = BTreeMap::new();
        let mut crowns: BTreeMap<u32, [f64; 4]> = BTreeMap::new();
        for it in boxes {
            let reach_m = it.half_m[0] + it.half_m[1];
            if !self.is_inside(self.px(it.center_m), reach_m) {
                continue;
            }
            match it.kind.as_str() {
                "tree_crown" => {
                    let bounds = crowns.entry(it.instance).or_insert([f64::INFINITY, f64::INFINITY, -1e9, -1e9]);
                    for axis in 0..2 {
                        bounds[axis] = bounds[axis].min(it.center_m[axis] - it.half_m[axis]);
                        bounds[axis + 2] = bounds[axis + 2].max(it.center_m[axis] + it.half_m[axis]);
                    }
                }
                "building" => shapes.entry("building").or_default().push(it),
                "wall" | "fence" | "bridge" | "guard_rail" => shapes.entry("wall").or_default().push(it),
                "car" => shapes.entry("car").or_default().push(it),
                "tree_trunk" | "pole" | "lamp" | "traffic_light" | "traffic_sign" => {}
                _ => shapes.entry("bush").or_default().push(it),
            }
        }
        for (kind, boxes) in shapes {
            let outlines: String = boxes.iter().take(MOST_BOXES).map(|it| self.outline(it)).collect();
            let _ = write!(svg, "<path class=\"{kind}\" d=\"{outlines}\"/>");
        }
        svg.push_str("<g class=\"crown\">");
        for [west, north, east, south] in crowns.values().take(MOST_BOXES) {
            let [x, y] = self.px([0.5 * (west + east), 0.5 * (north + south)]);
            let radius = 0.25 * (east - west + south - north) * self.px_per_m;
            let _ = write!(svg, "<circle cx=\"{x:.0}\" cy=\"{y:.0}\" r=\"{radius:.1}\"/>");
        }
        svg.push_str("</g>");
    }

    fn outline(&self, it: &BoxSketch) -> String {
        let (sin, cos) = cosfly_frames::real::sin_cos(it.yaw_rad);
        let corner = |a: f64, b: f64| {
            let (x, y) = (a * it.half_m[0], b * it.half_m[1]);
            self.px([it.center_m[0] + cos * x - sin * y, it.center_m[1] + sin * x + cos * y])
        };
        let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        format!("M{:.1} {:.1}L{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}Z", a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1])
    }

    fn walk(&self, svg: &mut String, flight: &FlightSketch) {
        let _ = write!(svg, "<path class=\"walk\" d=\"{}\"/>", self.way(&flight.feet_m));
    }

    /// Stretches of one class each; the colour of a segment is that of its first frame.
    fn flight(&self, svg: &mut String, flight: &FlightSketch) {
        let _ = write!(
            svg,
            "<g class=\"flight\"><title>{}: {:.1} % visible</title>",
            escaped(&flight.id),
            100.0 * flight.mean_visible()
        );
        let mut start = 0;
        while start + 1 < flight.len() {
            let class = class_of(flight.visible[start]);
            let last = flight.len() - 1;
            let end = (start..last).find(|at| class_of(flight.visible[*at]) != class).unwrap_or(last);
            let _ = write!(svg, "<path class=\"s{class}\" d=\"{}\"/>", self.way(&flight.drone_m[start..=end]));
            start = end;
        }
        if let (Some(place), Some(visible)) = (flight.drone_m.first(), flight.visible.first()) {
            let [x, y] = self.px([f64::from(place[0]), f64::from(place[1])]);
            let _ = write!(svg, "<circle class=\"f{}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4.5\"/>", class_of(*visible));
        }
        svg.push_str("</g>");
    }

    fn way(&self, places: &[[f32; 3]]) -> String {
        let mut path = String::new();
        for (at, place) in places.iter().enumerate() {
            let [x, y] = self.px([f64::from(place[0]), f64::from(place[1])]);
            let _ = write!(path, "{}{x:.1} {y:.1}", if at == 0 { 'M' } else { 'L' });
        }
        path
    }

    fn scale_bar(&self, svg: &mut String) {
        let length_m = statistics::round_step(90.0 / self.px_per_m);
        let (left, bottom) = (24.0, self.height - 24.0);
        let right = left + length_m * self.px_per_m;
        let _ = write!(
            svg,
            "<g class=\"bar\"><rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"36\" rx=\"4\"/>\
             <path d=\"M{left} {:.1}V{bottom}H{right:.1}V{:.1}\"/><text x=\"{:.1}\" y=\"{:.1}\" class=\"mid\">{length_m} m</text></g>",
            left - 10.0,
            bottom - 26.0,
            right - left + 20.0,
            bottom - 6.0,
            bottom - 6.0,
            0.5 * (left + right),
            bottom - 9.0
        );
    }
}

//! A made-up region of villages and one high tower, as OpenStreetMap and as CityJSON: thousands of buildings over many kilometres.

use cosfly_frames::{DVec2, Seed, real};
use std::fmt::Write;

/// Buildings of a village.
const HOUSES: usize = 100;
/// Houses along a village street.
const ALONG: usize = 20;
/// Distance between houses, and between streets, metres.
const SPACING_M: [f64; 2] = [26.0, 70.0];
/// Columns of villages.
const COLUMNS: usize = 6;
/// Distance between villages, east and south, metres.
const VILLAGES_M: [f64; 2] = [1500.0, 1333.0];
/// Height of the tower, metres.
pub const TOWER_M: f64 = 540.0;

/// A house: rectangles with a gable, or L-shaped ones with a level roof.
pub struct House {
    /// Corners in plan, x east, y north, metres.
    pub corners: Vec<DVec2>,
    /// Upper edge of the walls, metres.
    pub eaves_m: f64,
    /// Ridge above the walls, metres; 0 for a level roof.
    pub rise_m: f64,
}

/// The region.
pub struct WideTown {
    /// All houses; the tower is the last one.
    pub houses: Vec<House>,
    streets: Vec<[DVec2; 2]>,
}

impl WideTown {
    /// A region of `villages`, always the same; 90 are 9,001 buildings over 9 x 20 km.
    pub fn new(villages: usize) -> Self {
        let mut stream = Seed::of_item(9, "wide", "town").stream("houses");
        let mut region = Self { houses: Vec::new(), streets: Vec::new() };
        for village in 0..villages {
            let place = |index: usize, step_m: f64| index as f64 * step_m;
            let corner = DVec2::new(
                place(village % COLUMNS, VILLAGES_M[0]) + stream.uniform(0.0, 500.0),
                place(village / COLUMNS, VILLAGES_M[1]) + stream.uniform(0.0, 400.0),
            );
            let (sin, cos) = real::sin_cos(stream.uniform(0.0, 0.6));
            let at = |x: f64, y: f64| corner + DVec2::new(cos * x - sin * y, sin * x + cos * y);
            for house in 0..HOUSES {
                let (column, row) = (house % ALONG, house / ALONG);
                let [x, y] = [place(column, SPACING_M[0]) + 3.0, place(row, SPACING_M[1]) + 12.0];
                let (width, depth) = (stream.uniform(9.0, 20.0), stream.uniform(8.0, 14.0));
                let is_bent = stream.index(4) == 0;
                let plan: &[(f64, f64)] = if is_bent {
                    &[(0.0, 0.0), (1.0, 0.0), (1.0, 0.5), (0.4, 0.5), (0.4, 1.0), (0.0, 1.0)]
                } else {
                    &[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
                };
                let corners = plan.iter().map(|(right, up)| at(x + right * width, y + up * depth)).collect();
                let eaves_m = (10.0 * stream.uniform(3.0, 16.0)).round() / 10.0;
                region.houses.push(House { corners, eaves_m, rise_m: if is_bent { 0.0 } else { 3.0 } });
            }
            let width_m = place(ALONG, SPACING_M[0]);
            let rows = HOUSES / ALONG;
            region.streets.extend((0..=rows).map(|row| place(row, SPACING_M[1])).map(|y| [at(0.0, y), at(width_m, y)]));
            region.streets.push([at(0.0, 0.0), at(0.0, place(rows, SPACING_M[1]))]);
        }
        let low = DVec2::new(200.0, -120.0);
        let tower = [(0.0, 0.0), (55.0, 0.0), (55.0, 60.0), (0.0, 60.0)].map(|(x, y)| low + DVec2::new(x, y));
        region.houses.push(House { corners: tower.to_vec(), eaves_m: TOWER_M, rise_m: 0.0 });
        region
    }

    /// The region as an OpenStreetMap file, about 48 degrees north.
    pub fn osm(&self) -> String {
        // Metres of a degree east and north at the south-west corner: heights and counts are checked, not lengths.
        let degrees = |at: DVec2| (11.0 + at.x / 74_625.0, 48.0 + at.y / 111_200.0);
        let (mut nodes, mut ways) = (String::new(), String::new());
        let mut next = 1_i64;
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut node = |nodes: &mut String, at: DVec2| {
            (low, high) = (low.min(at), high.max(at));
            let (lon, lat) = degrees(at);
            let _ = writeln!(nodes, "<node id=\"{next}\" lon=\"{lon:.7}\" lat=\"{lat:.7}\"/>");
            next += 1;
            next - 1
        };
        for (number, house) in self.houses.iter().enumerate() {
            let ids: Vec<i64> = house.corners.iter().map(|corner| node(&mut nodes, *corner)).collect();
            let refs: String = ids.iter().chain(&ids[..1]).map(|id| format!("<nd ref=\"{id}\"/>")).collect();
            let top_m = house.eaves_m + house.rise_m;
            let roof = if house.rise_m > 0.0 {
                format!("<tag k=\"roof:shape\" v=\"gabled\"/><tag k=\"roof:height\" v=\"{}\"/>", house.rise_m)
            } else {
                String::new()
            };
            let tags = format!("<tag k=\"building\" v=\"yes\"/><tag k=\"height\" v=\"{top_m}\"/>{roof}");
            let _ = writeln!(ways, "<way id=\"{number}\">{refs}{tags}</way>");
        }
        for (number, street) in self.streets.iter().enumerate() {
            let refs: String = street.map(|end| format!("<nd ref=\"{}\"/>", node(&mut nodes, end))).concat();
            let tags = "<tag k=\"highway\" v=\"residential\"/><tag k=\"sidewalk\" v=\"both\"/>";
            let _ = writeln!(ways, "<way id=\"{}\">{refs}{tags}</way>", 1_000_000 + number);
        }
        let ((west, south), (east, north)) = (degrees(low), degrees(high));
        let bounds = format!("<bounds minlat=\"{south}\" minlon=\"{west}\" maxlat=\"{north}\" maxlon=\"{east}\"/>");
        format!("<osm version=\"0.6\">{bounds}\n{nodes}{ways}</osm>")
    }

    /// The region as a CityJSON file: solids with their roofs, no ground.
    pub fn city_json(&self) -> String {
        let (mut vertices, mut objects) = (Vec::<String>::new(), Vec::<String>::new());
        for (number, house) in self.houses.iter().enumerate() {
            let mut at = |point: DVec2, height_m: f64| {
                let [x, y, z] = [point.x, point.y, height_m].map(|value| (1000.0 * value).round());
                vertices.push(format!("[{x},{y},{z}]"));
                vertices.len() - 1
            };
            let count = house.corners.len();
            let foot: Vec<usize> = house.corners.iter().map(|corner| at(*corner, 0.0)).collect();
            let top: Vec<usize> = house.corners.iter().map(|corner| at(*corner, house.eaves_m)).collect();
            let side = |i: usize| (i, (i + 1) % count);
            let mut faces = vec![foot.iter().rev().copied().collect::<Vec<_>>()];
            let mut kinds = vec![0];
            if house.rise_m > 0.0 {
                let middle = |a: usize, b: usize| 0.5 * (house.corners[a] + house.corners[b]);
                let ridge = [(3, 0), (1, 2)].map(|(a, b)| at(middle(a, b), house.eaves_m + house.rise_m));
                faces.extend([vec![top[0], top[1], ridge[1], ridge[0]], vec![ridge[0], ridge[1], top[2], top[3]]]);
                kinds.extend([1, 1]);
                faces.push(vec![foot[0], foot[1], top[1], top[0]]);
                faces.push(vec![foot[1], foot[2], top[2], ridge[1], top[1]]);
                faces.push(vec![foot[2], foot[3], top[3], top[2]]);
                faces.push(vec![foot[3], foot[0], top[0], ridge[0], top[3]]);
            } else {
                faces.push(top.clone());
                kinds.push(1);
                faces.extend((0..count).map(side).map(|(a, b)| vec![foot[a], foot[b], top[b], top[a]]));
            }
            kinds.resize(faces.len(), 2);
            objects.push(format!(
                "\"b{number}\":{{\"type\":\"Building\",\"geometry\":[{{\"type\":\"Solid\",\"lod\":\"2.2\",\"boundaries\":[[{}]],\
                 \"semantics\":{{\"surfaces\":[{{\"type\":\"GroundSurface\"}},{{\"type\":\"RoofSurface\"}},{{\"type\":\"WallSurface\"}}],\
                 \"values\":[{kinds:?}]}}}}]}}",
                faces.iter().map(|face| format!("[{face:?}]")).collect::<Vec<_>>().join(",")
            ));
        }
        format!(
            "{{\"type\":\"CityJSON\",\"version\":\"2.0\",\"transform\":{{\"scale\":[0.001,0.001,0.001],\"translate\":[600000,5330000,500]}},\
             \"metadata\":{{\"referenceSystem\":\"https://www.opengis.net/def/crs/EPSG/0/25832\"}},\n\
             \"CityObjects\":{{{}}},\n\"vertices\":[{}]}}\n",
            objects.join(",\n"),
            vertices.join(",")
        )
    }
}

//! Passages through buildings: clear where the way leads, closed everywhere else.

use super::tests::{read, way};
use cosfly_domain::Town;
use cosfly_frames::{DVec2, DVec3, RandomStream, Seed, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_town::polygons::contains;

/// A file of nodes in metres east and south of (0, 0) degrees.
fn osm(nodes: &[(i64, DVec2)], rest: &str) -> String {
    let nodes: String = nodes
        .iter()
        .map(|(id, at)| {
            let (lon, lat) = (at.x / 111_319.491, -at.y / 110_574.276);
            format!("<node id=\"{id}\" lon=\"{lon:.9}\" lat=\"{lat:.9}\"/>\n")
        })
        .collect();
    let bounds = "<bounds minlat=\"-0.002\" minlon=\"-0.002\" maxlat=\"0.002\" maxlon=\"0.002\"/>";
    format!("<osm version=\"0.6\">{bounds}\n{nodes}{rest}</osm>")
}

fn points(places: &[(f64, f64)]) -> Vec<DVec2> {
    places.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
}

/// A house along `outline`, a way along `line`, and their tags.
fn town(outline: &[DVec2], house: &[(&str, &str)], line: &[DVec2], tags: &[(&str, &str)]) -> Town {
    let numbered = |first: i64, points: &[DVec2]| -> Vec<(i64, DVec2)> {
        points.iter().enumerate().map(|(index, point)| (first + index as i64, *point)).collect()
    };
    let (corners, nodes) = (numbered(100, outline), numbered(500, line));
    let ids = |nodes: &[(i64, DVec2)]| -> Vec<i64> { nodes.iter().map(|(id, _)| *id).collect() };
    let ring = [ids(&corners), vec![100]].concat();
    let rest = way(1, &ring, house) + &way(2, &ids(&nodes), tags);
    read(osm(&[corners, nodes].concat(), &rest).as_bytes()).unwrap().0
}

fn solid(town: &Town) -> impl Fn(DVec2, f64) -> bool {
    let boxes = BoxBvh::build(town.obstacles.iter().map(|one| one.shape).collect());
    move |at: DVec2, height_m: f64| boxes.nearest(DVec3::new(at.x, at.y, height_m), 1e-6).is_some()
}

/// The point of a line that is nearest to another.
fn nearest(point: DVec2, line: &[DVec2]) -> DVec2 {
    let on_side = |pair: &[DVec2]| {
        let along = pair[1] - pair[0];
        pair[0] + ((point - pair[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0) * along
    };
    let all = line.windows(2).map(on_side);
    all.min_by(|a, b| point.distance(*a).total_cmp(&point.distance(*b))).unwrap()
}

fn note(town: &Town) -> &str {
    town.synthetic.notes.iter().find(|note| note.contains("passages through buildings")).unwrap()
}

const HOUSE: [(&str, &str); 2] = [("building", "yes"), ("height", "12")];

#[test]
fn a_path_leads_through_a_house_and_the_storeys_above_stay() {
    let outline = points(&[(0.0, 0.0), (30.0, 0.0), (30.0, 12.0), (0.0, 12.0)]);
    let line = points(&[(10.0, 0.0), (10.0, 12.0)]);
    for (tags, clear_m, half_m) in [
        (&[("highway", "footway"), ("tunnel", "building_passage"), ("width", "2")][..], 3.0, 1.0),
        (&[("highway", "footway"), ("covered", "yes"), ("maxheight", "2.6")], 2.6, 1.1),
        (&[("highway", "steps"), ("tunnel", "building_passage"), ("maxheight", "1.9 m")], 2.2, 1.1),
        (&[("highway", "service"), ("tunnel", "building_passage")], 4.0, 1.75),
        (&[("highway", "service"), ("tunnel", "building_passage"), ("height", "11'6&quot;")], 3.5052, 1.75),
    ] {
        let town = town(&outline, &HOUSE, &line, tags);
        let solid = solid(&town);
        for step in 0..=12 {
            let y = f64::from(step);
            for aside in [-half_m, 0.0, half_m] {
                for height_m in [0.06, 1.0, clear_m - 0.02] {
                    assert!(!solid(DVec2::new(10.0 + aside, y), height_m), "{tags:?} {aside} {y} {height_m}");
                }
                assert!(y == 0.0 || y == 12.0 || solid(DVec2::new(10.0 + aside, y), clear_m + 0.02), "{tags:?}");
            }
        }
        assert!(solid(DVec2::new(10.0 + half_m + 0.6, 6.0), 0.1) && solid(DVec2::new(10.0 - half_m - 0.6, 6.0), 0.1));
        let assumed = usize::from(!tags.iter().any(|(key, _)| ["maxheight", "height"].contains(key)));
        assert!(note(&town).starts_with(&format!("1 passages through buildings are open ({assumed} of an assumed")));
    }
}

#[test]
fn only_the_building_that_a_passage_leads_through_opens() {
    let outline = points(&[(0.0, 0.0), (30.0, 0.0), (30.0, 12.0), (0.0, 12.0)]);
    let through = points(&[(10.0, -1.0), (10.0, 13.0)]);
    let covered = [("highway", "footway"), ("covered", "yes")];
    let count = |house: &[(&str, &str)], line: &[DVec2], tags: &[(&str, &str)]| {
        let town = town(&outline, house, line, tags);
        (
            town.obstacles.len(),
            note(&town).split(' ').next().unwrap().to_owned(),
            note(&town).contains(", 1 are closed"),
        )
    };
    assert_eq!(count(&HOUSE, &through, &covered), (3, "1".into(), false));
    // Along a wall of the house, at arm's length.
    assert_eq!(count(&HOUSE, &points(&[(0.0, -0.2), (30.0, -0.2)]), &covered), (1, "0".into(), false));
    // Under a canopy, and through a garage that is too low.
    assert_eq!(count(&[("building", "roof"), ("height", "4")], &through, &covered), (1, "0".into(), false));
    assert_eq!(count(&[("building", "garage"), ("height", "2.4")], &through, &covered), (1, "0".into(), true));
    // An upper walkway, a tunnel, a street that is covered but no passage, an open path.
    for tags in [
        &[("highway", "footway"), ("covered", "yes"), ("layer", "1")][..],
        &[("highway", "footway"), ("covered", "yes"), ("bridge", "yes")],
        &[("highway", "footway"), ("tunnel", "yes")],
        &[("highway", "residential"), ("covered", "yes")],
        &[("highway", "footway")],
    ] {
        assert_eq!(count(&HOUSE, &through, tags), (1, "0".into(), false), "{tags:?}");
    }
}

/// A house with wings or a yard, turned anyhow.
fn some_house(stream: &mut RandomStream) -> Vec<DVec2> {
    let mut size = |low: f64, high: f64| stream.uniform(low, high);
    let (width, depth, notch) = (size(14.0, 50.0), size(10.0, 30.0), size(0.2, 0.6));
    let all = [
        points(&[(0.0, 0.0), (width, 0.0), (width, depth), (0.0, depth)]),
        points(&[
            (0.0, 0.0),
            (width, 0.0),
            (width, notch * depth),
            (notch * width, notch * depth),
            (notch * width, depth),
            (0.0, depth),
        ]),
        points(&[
            (0.0, 0.0),
            (width, 0.0),
            (width, depth),
            (0.7 * width, depth),
            (0.7 * width, notch * depth),
            (0.3 * width, notch * depth),
            (0.3 * width, depth),
            (0.0, depth),
        ]),
    ];
    let (sin, cos) = real::sin_cos(size(0.0, 6.0));
    let outline = &all[stream.index(all.len())];
    outline.iter().map(|corner| DVec2::new(cos, sin).rotate(*corner - 0.5 * DVec2::new(width, depth))).collect()
}

#[test]
fn a_passage_is_clear_and_opens_a_building_nowhere_else() {
    let mut stream = Seed::of_item(7, "passages", "law").stream("houses");
    let mut open = 0;
    for round in 0..60 {
        let outline = some_house(&mut stream);
        let mut bend = || DVec2::new(stream.uniform(-12.0, 12.0), stream.uniform(-12.0, 12.0));
        let line = [bend() - DVec2::new(40.0, 0.0), bend(), bend() + DVec2::new(40.0, 0.0)];
        let clear_m = 2.3 + stream.uniform(0.0, 2.0);
        let stated = format!("{clear_m:.3}");
        let tags = [("highway", "path"), ("tunnel", "building_passage"), ("width", "2.4"), ("maxheight", &stated)];
        let house = [("building", "yes"), ("height", "14"), ("roof:shape", "gabled"), ("roof:height", "4")];
        let town = town(&outline, &house, &line, &tags);
        let solid = solid(&town);
        open += usize::from(note(&town).starts_with("1 "));
        for _ in 0..600 {
            let point = DVec2::new(stream.uniform(-30.0, 30.0), stream.uniform(-30.0, 30.0));
            let height_m = stream.uniform(0.06, 9.95);
            let on_way = nearest(point, &line);
            let away_m = point.distance(on_way);
            if away_m <= 1.2 && height_m < clear_m - 0.01 && contains(&outline, on_way) {
                assert!(!solid(point, height_m), "round {round}: {point} at {height_m} m, {away_m} m from the way");
            }
            // In the corner of a bend the clear ground reaches farthest.
            let is_elsewhere = away_m > 1.75 * core::f64::consts::SQRT_2 + 0.05 || height_m > clear_m + 0.01;
            // Places of nodes are told to a centimetre.
            let aside = [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y].map(|side| point + 0.03 * side);
            if is_elsewhere && aside.iter().all(|point| contains(&outline, *point)) {
                assert!(solid(point, height_m), "round {round}: {point} at {height_m} m, {away_m} m from the way");
            }
        }
    }
    assert!(open > 40, "{open} of 60 ways lead through their house");
}

//! Recorded people: every format, real files, and files with something wrong.

use cosfly_domain::{MapOrigin, Obstacle, ObstacleKind, OrientedBox, SemanticLabel, SurfaceMesh, Town};
use cosfly_frames::{DVec2, DVec3, Seed};
use cosfly_pedestrians::{RecordedConfig, Recording};
use cosfly_world::{Clock, Population, contacts, simulate};
use shared::shared_input;

#[path = "../../../../tests/shared.rs"]
mod shared;

/// A level square of ground at a height, around the origin.
fn field(half_m: f64, height_m: f64) -> Town {
    let corner = |x: f64, y: f64| DVec3::new(x * half_m, y * half_m, height_m);
    let ground = SurfaceMesh {
        label: SemanticLabel::SideWalks,
        vertices_in_world: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        along_across_m: vec![],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        synthetic: true,
    };
    let mut town = Town { name: "field".into(), surfaces: vec![ground], ..Town::default() };
    town.update_bounds();
    town
}

fn seed() -> Seed {
    Seed::of_item(1, "traffic", "recorded")
}

fn placed(text: &str, config: &RecordedConfig, town: &Town, clock: Clock) -> cosfly_world::Prescribed {
    Recording::read(text.as_bytes(), config).unwrap().placed(town, config, clock, seed()).unwrap()
}

#[test]
fn columns_become_people_on_the_ground_at_their_times() {
    let text = "time;person;y;x\n10;a;0;0\n11;a;0;1\n12;a;0;2\n11.5;b;5;5\n12.5;b;5;6\n";
    let clock = Clock::new(10, 0.5, 0.1);
    let people = placed(text, &RecordedConfig::default(), &field(50.0, 3.5), clock);
    let [a, b] = people.bodies() else { panic!("two people") };
    assert_eq!((a.plan.source.as_str(), a.first_frame, a.states.len()), ("a", 0, 5));
    assert_eq!((b.plan.source.as_str(), b.first_frame, b.states.len()), ("b", 3, 3));
    let places: Vec<DVec3> = a.states.iter().map(|state| state.feet_in_world).collect();
    assert_eq!(places, [0.0, 0.5, 1.0, 1.5, 2.0].map(|x| DVec3::new(x, 0.0, 3.5)));
    assert!(a.states.iter().all(|state| (state.speed_mps, state.heading_rad) == (1.0, 0.0)));
    // y of the file is to the left.
    assert_eq!(b.states[0].feet_in_world, DVec3::new(5.0, -5.0, 3.5));
}

#[test]
fn frames_need_a_rate_and_the_recording_can_be_turned_and_moved() {
    let text = "0 7 1.0 0.0\n25 7 2.0 0.0\n";
    let config =
        RecordedConfig { rate_hz: Some(25.0), origin_m: [10.0, 20.0], turn_deg: 90.0, ..RecordedConfig::default() };
    let people = placed(text, &config, &field(50.0, 0.0), Clock::new(4, 0.5, 0.1));
    let places: Vec<DVec2> = people.bodies()[0].states.iter().map(|state| state.feet_in_world.truncate()).collect();
    for (place, y) in places.iter().zip([21.0, 21.5, 22.0]) {
        assert!(place.distance(DVec2::new(10.0, y)) < 1e-12, "{places:?}");
    }
    assert_eq!(places.len(), 3);
}

#[test]
fn degrees_are_projected_by_the_town() {
    let mut town = field(500.0, 0.0);
    let geo_reference = Some("+proj=tmerc +lat_0=48 +lon_0=11 +k=1 +x_0=0 +y_0=0".to_owned());
    town.origin = MapOrigin { geo_reference, ..MapOrigin::default() };
    let gpx = r#"<?xml version="1.0"?><gpx xmlns="http://www.topografix.com/GPX/1/1"><trk><name>Ada</name><trkseg>
<trkpt lat="48.0" lon="11.0"><time>2024-05-01T10:00:00Z</time></trkpt>
<trkpt lat="48.0001" lon="11.0"><time>2024-05-01T10:00:05Z</time></trkpt>
<trkpt lat="48.0002" lon="11.0"/></trkseg></trk></gpx>"#;
    let lines = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"name":"Ada",
"coordTimes":["2024-05-01T10:00:00Z",1714557605000]},"geometry":{"type":"LineString","coordinates":[[11,48],[11,48.0001]]}},
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[]}}]}"#;
    let points = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"id":"Ada","time":"2024-05-01T10:00:00Z"},"geometry":{"type":"Point","coordinates":[11,48]}},
{"type":"Feature","properties":{"id":"Ada","time":1714557605},"geometry":{"type":"Point","coordinates":[11,48.0001]}}]}"#;
    for text in [gpx, lines, points] {
        let people = placed(text, &RecordedConfig::default(), &town, Clock::new(11, 0.5, 0.1));
        let [ada] = people.bodies() else { panic!("one person") };
        assert_eq!((ada.plan.source.as_str(), ada.states.len()), ("Ada", 11));
        let last = ada.states[10].feet_in_world;
        // A ten-thousandth of a degree of latitude is 11.12 m; north is -y.
        assert!(last.distance(DVec3::new(0.0, -11.12, 0.0)) < 0.01, "{last}");
        assert!((ada.states[5].speed_mps - 2.224).abs() < 1e-3);
    }
    let recording = Recording::read(gpx.as_bytes(), &RecordedConfig::default()).unwrap();
    assert_eq!(recording.warnings, ["1 points without a time are left out"]);
    let clock = Clock::new(4, 0.5, 0.1);
    let refused = recording.placed(&field(9.0, 0.0), &RecordedConfig::default(), clock, seed()).unwrap_err();
    assert_eq!(refused.message, "the tracks are in degrees, but the town `field` has no geographic reference");
}

#[test]
fn broken_files_are_refused_with_their_line() {
    for (text, expected) in [
        ("t,id,x,y\n0,1,0,0\n1,1,nan,0\n", "`nan` in column `x` is not a finite number (line 3)"),
        ("0,1,0,0\n1,1,0\n", "the row has 3 columns; 4 are needed (line 2)"),
        ("t,id,x,y\n0,1,0,5,1,5\n", "the row has more columns than the first line, which has 4 (line 2)"),
        (
            "frame,id,x,y\n0,1,0,0\n1,1,1,0\n",
            "the column `frame` counts frames, and nothing says how many there are in a second (line 1)",
        ),
        ("t;id;x;y\n0;1;10,5;2\n", "`10,5` in column `x` is not a finite number (line 2)"),
        ("0,1,2,1e300\n", "`1e300` in column `y` is no place in metres: it must be between -1e9 and 1e9 (line 1)"),
        ("t,name,x,y\n", "the header has no column `id` (line 1)"),
        ("t,pedestrian,lon,lat\n", "the header has no column `x` (line 1)"),
        ("0,1,0,0\n\n# a comment\n2,1,1,1\n1,1,0,0\n", "the time of `1` runs backwards by 1.000 s (line 5)"),
        ("", "the file has no track with time"),
        ("0,1,0,0\n", "the file has no track with time"),
        (
            "0,1,0,0\n1,1,90,0\n",
            "no two points of a track follow each other at `max_speed_mps`, 8, or less; the first jump is at 90.0 m/s, of `1` (line 2)",
        ),
        ("1 2 3 4 5 6 7 8\n1 2 3\n", "a row of an `obsmat` file has 8 numbers; this one has 3 (line 2)"),
        ("1 x 3 4 5 6 7 8\n", "`x` in column `id` is not a finite number (line 1)"),
        ("<kml></kml>", "the file begins with `<kml>`, not with `<gpx>` (line 1)"),
        ("<gpx><rte><rtept lat=\"1\" lon=\"0\"/></rte>\n</gpx>", "the file has no `<trk>` (line 2)"),
        ("<gpx><trk>\n<trkseg>\n", "the file ends before `</gpx>` (line 3)"),
        (
            "<gpx><trk><trkseg>\n<trkpt lat=\"91\" lon=\"0\"/></trkseg></trk></gpx>",
            "`lat` is `91`; it must be a number within -90 and 90 (line 2)",
        ),
        (
            "<gpx><trk><trkseg>\n<trkpt lat=\"1\" lon=\"0\">\n<time>noon</time></trkpt></trkseg></trk></gpx>",
            "`noon` is not a time (line 3)",
        ),
        ("{", "broken JSON: EOF while parsing an object at line 1 column 1 (line 1)"),
        ("{\"type\": \"Topology\"}", "the JSON is neither a `FeatureCollection` nor a `Feature`"),
        (
            "{\"type\":\"Feature\",\"properties\":{\"times\":[1]},\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[0,0],[0,1]]}}",
            "`feature 1`: it has 2 points and 1 times",
        ),
    ] {
        let error = Recording::read(text.as_bytes(), &RecordedConfig::default()).unwrap_err();
        assert_eq!(error.to_string(), expected, "{text}");
        assert!(!error.hint.is_empty(), "{text}");
    }
    let error = Recording::read(b"0,1,0,0\n\xff\xfe", &RecordedConfig::default()).unwrap_err();
    assert_eq!(error.to_string(), "the file is not UTF-8 text (line 2)");
}

/// A text that is refused with some advice; then the text and the settings that the advice asks for, which are read.
#[test]
fn the_advice_of_refusals_helps() {
    let plain = RecordedConfig::default();
    let rate = |rate_hz: f64| RecordedConfig { rate_hz: Some(rate_hz), ..RecordedConfig::default() };
    let frames = "frame,id,x,y\n0,1,0,0\n25,1,1,0\n";
    let at_noon = |time: &str, lat: &str| {
        format!(
            "<gpx><trk><trkseg>\n<trkpt lat=\"{lat}\" lon=\"0\"><time>{time}</time></trkpt>\n\
             <trkpt lat=\"1\" lon=\"0\"><time>2024-05-01T12:00:05Z</time></trkpt></trkseg></trk></gpx>"
        )
    };
    let right = at_noon("2024-05-01T12:00:00Z", "1");
    let line = |times: &str| {
        format!(
            "{{\"type\":\"Feature\",\"properties\":{{\"coordTimes\":{times}}},\
             \"geometry\":{{\"type\":\"LineString\",\"coordinates\":[[0,0],[0,1e-5]]}}}}"
        )
    };
    for (text, advice, mended, config) in [
        ("t;id;x;y\n0;1;10,5;2\n1;1;10,6;2\n", "as in `10.5`", "t;id;x;y\n0;1;10.5;2\n1;1;10.6;2\n", plain.clone()),
        ("t,id,x,y\n0,1,0,5,1,5\n", "as in `10.5`", "t,id,x,y\n0,1,0.5,1.5\n1,1,0.5,1.6\n", plain.clone()),
        ("0,1,0,0\n1,1,0\n", "time, id, x, y with commas", "0,1,0,0\n1,1,0,0.5\n", plain.clone()),
        (
            "t,id,x,y\n0,1,0,0\n1,1,nan,0\n2,1,1,0\n",
            "leave out the rows",
            "t,id,x,y\n0,1,0,0\n2,1,1,0\n",
            plain.clone(),
        ),
        ("0,1,2,0\n1,1,2,1\n2,1,2,1e300\n", "leave out broken rows", "0,1,2,0\n1,1,2,1\n", plain.clone()),
        (frames, "set `rate_hz`", frames, rate(25.0)),
        (
            "t,name,x,y\n0,1,0,0\n1,1,0,1\n",
            "name the columns `t`, `id`, `x`, `y`",
            "t,id,x,y\n0,1,0,0\n1,1,0,1\n",
            plain.clone(),
        ),
        (
            "t,id,x,x_m,y\n",
            "rename the one that is not to be read",
            "t,id,x,seen_x,y\n0,1,0,9,0\n1,1,0,9,1\n",
            plain.clone(),
        ),
        (
            "0,1,0,0\n2,1,1,1\n1,1,0,0\n",
            "sort the points of each person by time",
            "0,1,0,0\n1,1,0,0\n2,1,1,1\n",
            plain.clone(),
        ),
        ("0,1,0,0\n1,1,90,0\n", "`rate_hz` is for times in frames", "0,1,0,0\n1,1,90,0\n", rate(0.05)),
        ("0,1,0,0\n", "at least one person with two points", "0,1,0,0\n1,1,1,0\n", plain.clone()),
        ("0,1,0,0\n400,1,1,0\n800,1,2,0\n", "`rate_hz = 1000`", "0,1,0,0\n400,1,1,0\n800,1,2,0\n", rate(1000.0)),
        (&at_noon("noon", "1"), "times look like `2010-10-03T09:36:30Z`", &right, plain.clone()),
        (&at_noon("2024-05-01T12:00:00Z", "91"), "`lat` and `lon` in degrees", &right, plain.clone()),
        (&line("[1]"), "one time per vertex in `coordTimes`", &line("[1, 2]"), plain.clone()),
    ] {
        let error = Recording::read(text.as_bytes(), &RecordedConfig::default()).expect_err(text);
        assert!(error.hint.contains(advice), "`{advice}` in `{}`", error.hint);
        let read = Recording::read(mended.as_bytes(), &config);
        assert!(read.is_ok(), "`{advice}`: {read:?}");
    }
}

#[test]
fn the_advice_about_times_and_places_helps() {
    let (town, clock) = (field(50.0, 0.0), Clock::new(4, 0.5, 0.1));
    let text = "100,1,0,0\n101,1,1,0\n900,2,0,0\n901,2,1,0\n";
    let place = |text: &str, config: &RecordedConfig| {
        Recording::read(text.as_bytes(), config).unwrap().placed(&town, config, clock, seed())
    };
    let late = RecordedConfig { start_s: 50.0, ..RecordedConfig::default() };
    assert!(place(text, &late).unwrap_err().hint.contains("change `start_s`"));
    assert!(place(text, &RecordedConfig { start_s: 800.0, ..RecordedConfig::default() }).is_ok());
    let away = text.replace(",0,0", ",9000,0").replace(",1,0", ",9001,0");
    assert!(place(&away, &RecordedConfig::default()).unwrap_err().hint.contains("check `origin_m`"));
    assert!(place(&away, &RecordedConfig { origin_m: [-9000.0, 0.0], ..RecordedConfig::default() }).is_ok());
}

#[test]
fn what_is_there_twice_is_refused_or_said() {
    let read = |text: &str| Recording::read(text.as_bytes(), &RecordedConfig::default());
    let gpx = r#"<gpx><wpt lat="1" lon="2"/><trk><name>Ada</name>
<trkpt lat="48.0" lon="11.0"><time>2024-05-01T10:00:00Z</time></trkpt><trkseg>
<trkpt lat="48.0" lon="11.0"><time>2024-05-01T10:00:00Z</time><extensions><time>never</time></extensions></trkpt>
<trkpt lat="48.0001" lon="11.0"><time>2024-05-01T10:00:05Z</time></trkpt></trkseg></trk></gpx>"#;
    assert_eq!(
        read(gpx).unwrap().warnings,
        ["1 points outside of a `<trkseg>` are left out", "1 way points and routes are left out: they say no times"]
    );
    let time = "<time>2024-05-01T10:00:05Z</time>";
    for (from, to, name, line) in [
        (time, &*format!("{time}{time}"), "time", 4),
        ("</name>", "</name><name>Bob</name>", "name", 1),
        ("<trkseg>", "<trk></trk><trkseg>", "trk", 2),
    ] {
        let error = read(&gpx.replace(from, to)).unwrap_err();
        assert_eq!((error.message, error.line), (format!("a second `<{name}>` where one may be"), Some(line)));
    }
    let track = "<trk><name>Ada</name><trkseg><trkpt lat=\"48\" lon=\"11\"><time>2024-05-01T10:00:00Z</time></trkpt>\
                 <trkpt lat=\"48\" lon=\"11.00001\"><time>2024-05-01T10:00:05Z</time></trkpt></trkseg></trk>";
    let warnings = read(&format!("<gpx>{track}{track}</gpx>")).unwrap().warnings;
    assert!(warnings[0].contains("2 tracks are called `Ada`"), "{warnings:?}");
    let warnings = |text: &str| read(text).unwrap().warnings;
    assert_eq!(warnings("0,1,0,0,\n1,1,1,0\n"), ["the file has no header: its columns count as time, id, x, y"]);
    assert!(warnings("t,id,x,y\n0,1,0,0,\n1,1,1,0\n").is_empty(), "an empty last column is none");
    let error = read("t,id,x,y,x_m\n0,1,0,0,0\n").unwrap_err();
    assert!(error.message.contains("two columns for `x`: `x` and `x_m`"), "{error}");
    let error = read("1e23,1,0,0\n").unwrap_err();
    assert!(error.message.contains("is no time or number"), "{error}");
    let crs =
        r#"{"type":"FeatureCollection","crs":{"properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},"features":[]}"#;
    assert!(read(crs).unwrap_err().message.contains("`crs` is `urn:ogc:def:crs:EPSG::25832`"));
    let error = read("{\"type\":\"FeatureCollection\",\n\"features\":[],\"features\":[]}").unwrap_err();
    assert!(error.message.contains("`features` is there twice") && error.line == Some(2), "{error}");
    let degrees = read(&crs.replace("EPSG::25832", "OGC:1.3:CRS84")).unwrap_err();
    assert_eq!(degrees.message, "the file has no track with time");
}

#[test]
fn what_is_odd_is_counted_and_said() {
    // A jump at line 4, a repeated time, a gap of 37 s, a lone point, a house in the way, and a way out of the town.
    let text = "0,a,0,0\n1,a,1,0\n1,a,1,0\n2,a,30,0\n3,a,31,0\n40,a,32,0\n41,a,33,0\n0,b,0,9\n0,c,48,0\n4,c,52,0\n";
    let mut town = field(50.0, 0.0);
    let shape = OrientedBox {
        center_in_world: DVec3::new(0.5, 0.0, 5.0),
        half_extents_m: DVec3::new(0.3, 0.3, 5.0),
        yaw_rad: 0.0,
    };
    town.obstacles.push(Obstacle { shape, kind: ObstacleKind::Building, object_id: 1, synthetic: true });
    let clock = Clock::new(90, 0.5, 0.1);
    let people = placed(text, &RecordedConfig::default(), &town, clock);
    let names: Vec<&str> = people.bodies().iter().map(|body| body.plan.source.as_str()).collect();
    assert_eq!(names, ["a", "a / 2", "a / 3", "c"]);
    let warnings = Recording::read(text.as_bytes(), &RecordedConfig::default()).unwrap().warnings;
    assert_eq!(
        [warnings, people.notes()].concat(),
        [
            "the file has no header: its columns count as time, id, x, y",
            "1 points at the time of the point before are left out",
            "tracks are parted at 1 jumps, the first of `a` at 29.0 m/s (line 4); `max_speed_mps` is 8",
            "tracks are parted at 1 gaps longer than `max_gap_s`, 30 s",
            "1 tracks of one point are left out",
            "recorded people leave the town: 4 of their frames are left out",
            "1 recorded people cross the town's things in 3 frames, the first is `a` at (0.0, 0.0)",
        ]
    );
    let late = RecordedConfig { start_s: 500.0, ..RecordedConfig::default() };
    let recording = Recording::read(text.as_bytes(), &late).unwrap();
    let error = recording.placed(&town, &late, clock, seed()).unwrap_err();
    assert_eq!(error.to_string(), "no recorded person is present in the 45 s from `start_s` on");
    let far = RecordedConfig { origin_m: [5000.0, 0.0], ..RecordedConfig::default() };
    let error = recording.placed(&town, &far, clock, seed()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "none of the 4 recorded people is in the town: the first place is 5000 m from its middle"
    );
}

#[test]
fn damaged_files_never_panic() {
    let texts = [
        "t,id,x,y\n0,1,0,0\n1,1,1,0\n2,\"1\",2,0\n",
        "1 1 0 0 0 0 0 0\n11 1 0.5 0 0 0 0 0\n",
        "<gpx><trk><name>a</name><trkseg><trkpt lat='1' lon='2'><time>2020-01-01T00:00:00Z</time></trkpt></trkseg></trk></gpx>",
        r#"{"type":"Feature","properties":{"coordTimes":[1,2]},"geometry":{"type":"LineString","coordinates":[[0,0],[0,1]]}}"#,
    ];
    let mut random = Seed([9; 32]).stream("damage");
    for text in texts {
        for _ in 0..4_000 {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..=random.index(3) {
                let at = random.index(bytes.len());
                match random.index(3) {
                    0 => bytes[at] = random.bits() as u8,
                    1 => bytes.truncate(at.max(1)),
                    _ => bytes.insert(at, b"0123456789eE.-+,;<>\"'{}[]/: \n"[random.index(29)]),
                }
            }
            if let Ok(recording) = Recording::read(&bytes, &RecordedConfig::default()) {
                let clock = Clock::new(20, 0.5, 0.1);
                let _ = recording.placed(&field(50.0, 0.0), &RecordedConfig::default(), clock, seed());
            }
        }
    }
}

#[test]
fn people_of_zara_and_of_the_university_walk_in_a_field_and_none_overlap() {
    for (name, people, rows) in [("zara01", 148, 5_024), ("students03", 400, 21_846)] {
        let Some(path) = shared_input(&format!("pedestrians/UCY/{name}/obsmat.txt")) else { return };
        let bytes = std::fs::read(path).unwrap();
        let config = RecordedConfig::default();
        let recording = Recording::read(&bytes, &config).unwrap();
        let points: usize = recording.tracks.iter().map(|track| track.points.len()).sum();
        println!("{name}: {} tracks, {points} points, {:?}", recording.tracks.len(), recording.warnings);
        assert_eq!(points, rows);
        assert!(recording.tracks.len() >= people);
        let clock = Clock::new(200, 0.4, 0.1);
        let population = recording.placed(&field(50.0, 0.0), &config, clock, seed()).unwrap();
        println!("{:?}", population.notes());
        let known = population.bodies().to_vec();
        let traffic = simulate(&mut [Box::new(population) as Box<dyn Population>], clock, |_| Ok::<_, ()>(())).unwrap();
        assert_eq!(traffic.bodies, known);
        assert_eq!(contacts(&traffic, 0.0), []);
        // Frames of 0.4 s are the annotated ones: every place is that of the file.
        let first = &recording.tracks[0];
        for (point, state) in first.points.iter().zip(&known[0].states) {
            let place = DVec2::new(point.at.x, -point.at.y);
            assert!(state.feet_in_world.truncate().distance(place) < 1e-9, "{name}");
        }
    }
}

#[test]
fn a_real_hike_is_read_and_its_points_without_time_are_counted() {
    let Some(path) = shared_input("gpx/korita-zbevnica.gpx") else { return };
    let bytes = std::fs::read(path).unwrap();
    let config = RecordedConfig { max_gap_s: 300.0, ..RecordedConfig::default() };
    let recording = Recording::read(&bytes, &config).unwrap();
    let points: usize = recording.tracks.iter().map(|track| track.points.len()).sum();
    println!("{} tracks, {points} points, {:?}", recording.tracks.len(), recording.warnings);
    assert!(recording.is_geographic && points > 450);
    assert!(recording.warnings[0].ends_with("points without a time are left out"));
    let short = RecordedConfig { max_gap_s: 1.0, ..RecordedConfig::default() };
    let error = Recording::read(&bytes, &short).unwrap_err();
    assert!(error.hint.contains("max_gap_s"), "{error:?}");
}

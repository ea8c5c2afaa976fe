//! Floating-car data of SUMO: places, angles, frames between steps, gaps, refusals, memory.

use cosfly_domain::{BodyKind, Town};
use cosfly_frames::{DVec2, DVec3, Seed, real};
use cosfly_vehicles::fcd::{FcdConfig, FcdError, FcdProjection, FcdType, NetLocation, read};
use cosfly_world::{Clock, Population, Prescribed, simulate};
use std::collections::BTreeMap;
use std::io::{BufReader, Read};

fn town() -> Town {
    Town { min_in_world: DVec3::splat(-200.0), max_in_world: DVec3::splat(200.0), ..Town::default() }
}

fn config() -> FcdConfig {
    let taxi = FcdType { kind: BodyKind::Car, size_m: Some([4.0, 1.8, 1.5]) };
    FcdConfig { types: BTreeMap::from([("taxi".to_owned(), taxi)]), ..FcdConfig::default() }
}

fn read_with(text: &str, config: &FcdConfig, clock: Clock) -> Result<Prescribed, FcdError> {
    let net = NetLocation { offset_m: DVec2::new(100.0, 50.0), projection: None };
    read(text.as_bytes(), &FcdProjection::new(&town(), &net, false).unwrap(), config, clock, Seed([1; 32]))
}

fn vehicle(id: &str, x: f64, y: f64, angle: f64) -> String {
    format!(
        "<vehicle id=\"{id}\" x=\"{x}\" y=\"{y}\" angle=\"{angle}\" type=\"taxi\" speed=\"5\" pos=\"0\" lane=\"a_0\" slope=\"0\"/>\n"
    )
}

fn step(time: f64, rest: &str) -> String {
    format!("<timestep time=\"{time}\">\n{rest}</timestep>\n")
}

fn file(steps: &str) -> String {
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- generated -->\n<fcd-export>\n{steps}</fcd-export>\n")
}

#[test]
fn vehicles_are_where_their_front_bumpers_say_and_move_evenly_between_steps() {
    // North, then east: the file's y grows to the north, the world's to the south.
    let text = file(&(step(0.0, &vehicle("a", 100.0, 52.0, 0.0)) + &step(1.0, &vehicle("a", 104.0, 50.0, 90.0))));
    let recorded = read_with(&text, &config(), Clock::new(3, 0.5, 0.5)).unwrap();
    let [body] = recorded.bodies() else { panic!("one body") };
    assert_eq!((body.plan.source.as_str(), body.plan.kind, body.first_frame), ("a", BodyKind::Car, 0));
    let states: Vec<[f64; 3]> =
        body.states.iter().map(|it| [it.feet_in_world.x, it.feet_in_world.y, it.heading_rad]).collect();
    let expected = [[0.0, 0.0, -real::FRAC_PI_2], [1.0, 0.0, -0.25 * real::PI], [2.0, 0.0, 0.0]];
    for (state, expected) in states.iter().zip(expected) {
        let off = state.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9, "{states:?}");
    }
    let mut populations: [Box<dyn Population>; 1] = [Box::new(recorded.clone())];
    let traffic = simulate(&mut populations, Clock::new(3, 0.5, 0.1), |_| Ok::<_, ()>(())).unwrap();
    assert_eq!(traffic.bodies[0].states, body.states, "steps between frames change no frame");
}

#[test]
fn people_and_those_who_leave_and_come_back() {
    let person = "<person id=\"p\" x=\"110\" y=\"50\" angle=\"180\" speed=\"1.2\" type=\"DEFAULT_PEDTYPE\"/>\n";
    let car = vehicle("car &amp; co", 120.0, 50.0, 90.0);
    let jumped = vehicle("car &amp; co", 220.0, 50.0, 90.0);
    let text = file(
        &(step(0.0, person)
            + &step(1.0, &(person.to_owned() + &car))
            + &step(2.0, &car)
            + &step(3.0, &(person.to_owned() + &jumped))
            + &step(4.0, &jumped)),
    );
    let recorded = read_with(&text, &config(), Clock::new(5, 1.0, 1.0)).unwrap();
    let seen: Vec<(&str, BodyKind, u32, u32)> = recorded
        .bodies()
        .iter()
        .map(|it| (it.plan.source.as_str(), it.plan.kind, it.first_frame, it.end_frame()))
        .collect();
    let (person, car) = (BodyKind::Pedestrian, BodyKind::Car);
    let mut expected = vec![("p", person, 0, 2), ("car & co", car, 1, 3), ("car & co", car, 3, 5), ("p", person, 3, 4)];
    expected.sort_by_key(|it| (it.2, it.0));
    assert_eq!(seen, expected);
    assert!(recorded.notes().iter().any(|note| note.contains("1 jumps")), "{:?}", recorded.notes());
}

#[test]
fn what_cannot_be_used_is_refused_at_its_line() {
    let refusal = |text: &str| read_with(text, &config(), Clock::new(3, 1.0, 1.0)).unwrap_err().to_string();
    let good = step(0.0, &vehicle("a", 100.0, 50.0, 0.0));
    for (text, expected) in [
        (file(&(step(1.0, "") + &step(0.5, ""))), "time goes from 1 s to 0.5 s; it must grow (line 7)"),
        (
            file(&step(0.0, &vehicle("a", f64::NAN, 0.0, 0.0))),
            "`x` is `NaN`; it must be a number between -1e9 and 1e9 (line 5)",
        ),
        (file(&step(0.0, "<vehicle id=\"a\" x=\"1\" y=\"2\" speed=\"1\"/>\n")), "`vehicle` has no `angle` (line 5)"),
        (file(&step(0.0, &vehicle("a", 1e5, 0.0, 0.0))), "all 1 positions lie outside of the town"),
        (file(&step(0.0, &vehicle("a", 100.0, 50.0, 0.0).repeat(2))), "`a` is twice in the time step 0 s (line 7)"),
        (
            format!("<fcd-export>\n<timestep time=\"0\">\n{}", vehicle("a", 100.0, 50.0, 0.0)),
            "the file ends within a time step (line 4)",
        ),
        ("<net>\n</net>".to_owned(), "the file is no floating-car data: its root is not `<fcd-export>` (line 1)"),
        (String::new(), "the file is empty (line 1)"),
        (format!("<fcd-export>\n{good}<timestep time=\"1\"></vehicle>"), "broken XML"),
        (file(""), "nobody is in the file between 0 s and 2 s"),
        (
            format!("<fcd-export>\n<timestep time=\"0\">\n{good}</timestep></fcd-export>"),
            "a `<timestep>` within another one (line 3)",
        ),
        (file(&good.replace("x=", "y=\"3\" x=")), "broken XML"),
    ] {
        let found = refusal(&text);
        assert!(found.starts_with(expected), "{found}\nexpected {expected}");
    }
    assert!(
        refusal(&format!("<fcd-export><timestep time=\"0\"><vehicle id=\"{}\"", "x".repeat(3 << 20))).contains("1 MiB")
    );
}

#[test]
fn the_advice_of_refusals_helps() {
    let late = file(&step(500.0, &vehicle("a", 100.0, 50.0, 0.0)));
    let begin = |begin_s: f64| read_with(&late, &FcdConfig { begin_s, ..config() }, Clock::new(3, 1.0, 1.0));
    assert!(begin(0.0).unwrap_err().hint.unwrap().contains("set `begin_s` to a time with traffic"));
    assert_eq!(begin(500.0).unwrap().bodies().len(), 1);

    let mut town = town();
    town.origin.geo_reference = Some("+proj=utm +zone=33 +datum=WGS84".into());
    (town.min_in_world, town.max_in_world) = (DVec3::splat(-1e7), DVec3::splat(1e7));
    let net = NetLocation { offset_m: DVec2::ZERO, projection: Some("+proj=utm +zone=33 +datum=WGS84".into()) };
    let read_as = |text: &str, geo: bool| {
        let place = FcdProjection::new(&town, &net, geo).unwrap();
        read(text.as_bytes(), &place, &FcdConfig { geo, ..config() }, Clock::new(3, 1.0, 1.0), Seed([1; 32]))
    };
    let option = "<!-- generated\n<fcd-output.geo value=\"true\"/>\n-->";
    let degrees = file(&step(0.0, &vehicle("a", 13.4, 52.4, 0.0))).replace("<!-- generated -->", option);
    assert!(read_as(&degrees, false).unwrap_err().hint.unwrap().contains("set `geo = true`"));
    assert_eq!(read_as(&degrees, true).unwrap().bodies().len(), 1);
    let metres = file(&step(0.0, &vehicle("a", 393_806.0, 5_815_232.0, 0.0)));
    assert!(read_as(&metres, true).unwrap_err().hint.unwrap().contains("leave out `geo`"));
    assert_eq!(read_as(&metres, false).unwrap().bodies().len(), 1);
}

#[test]
fn degrees_are_told_from_metres_by_the_file_and_by_its_speeds() {
    let refusal = |text: &str, geo: bool| {
        let mut town = town();
        town.origin.geo_reference = Some("+proj=utm +zone=33 +datum=WGS84".into());
        let net = NetLocation { offset_m: DVec2::ZERO, projection: Some("+proj=utm +zone=33 +datum=WGS84".into()) };
        let config = FcdConfig { geo, ..config() };
        let place = FcdProjection::new(&town, &net, geo).unwrap();
        read(text.as_bytes(), &place, &config, Clock::new(21, 1.0, 1.0), Seed([1; 32])).unwrap_err()
    };
    let option = "<!-- generated\n<fcd-output.geo value=\"true\"/>\n-->";
    let good = file(&step(0.0, &vehicle("a", 13.4, 52.4, 0.0)));
    let error = refusal(&good.replace("<!-- generated -->", option), false);
    assert!(error.to_string().starts_with("the positions of the file are degrees, but `geo` is false"), "{error}");
    assert!(error.hint.unwrap().contains("`geo = true`"));
    // A car that drives 5 m/s for 20 s moves by a thousandth of a degree.
    let steps: String =
        (0..21).map(|at| step(f64::from(at), &vehicle("a", 13.4 + 5e-5 * f64::from(at), 52.4, 90.0))).collect();
    let error = refusal(&file(&steps), false);
    assert!(error.to_string().contains("bodies move by 0.0"), "{error}");
    let error = refusal(&file(&step(0.0, &vehicle("a", 393806.0, 5815232.0, 0.0))), true);
    assert!(error.to_string().contains("is no longitude and latitude"), "{error}");
}

#[test]
fn elements_of_other_names_are_counted_and_nets_say_their_place_once() {
    let text = file(&step(0.0, &(vehicle("a", 100.0, 50.0, 0.0) + "<vehicel id=\"b\"/>")));
    let recorded = read_with(&text, &config(), Clock::new(1, 1.0, 1.0)).unwrap();
    assert!(recorded.notes().iter().any(|note| note.contains("1 elements of other names are left out: `<vehicel>`")));
    let location = "<location netOffset='1,2' projParameter='+proj=utm +zone=33'/>\n";
    let net = NetLocation::of_net(format!("<net>\n{location}").as_bytes()).unwrap();
    assert_eq!((net.offset_m, net.projection.as_deref()), (DVec2::new(1.0, 2.0), Some("+proj=utm +zone=33")));
    let twice = NetLocation::of_net(format!("<net>\n{location}{location}").as_bytes()).unwrap_err();
    assert!(twice.to_string().contains("a second `<location>`") && twice.line == Some(3), "{twice}");
    // A projection of SUMO's own cannot be compared with that of a map.
    let net = NetLocation { offset_m: DVec2::ZERO, projection: Some("-".into()) };
    assert!(FcdProjection::new(&town(), &net, false).is_ok());
    let mut placed = town();
    placed.origin.geo_reference = Some("+proj=utm +zone=33 +units=us-ft".into());
    let error = FcdProjection::new(&placed, &net, false).err().unwrap();
    assert!(error.to_string().contains("projection `-` of the net"), "{error}");
    let error = FcdProjection::new(&placed, &net, true).err().unwrap();
    assert!(error.to_string().contains("`+units=us-ft` is not read"), "{error}");
}

/// A file that never ends: cars that drive on a line.
struct Endless {
    step: u64,
    ready: Vec<u8>,
    given: usize,
}

impl Read for Endless {
    fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
        if self.given == self.ready.len() {
            let cars: String = (0..50)
                .map(|car| vehicle(&format!("v{car}"), 100.0 + 0.001 * self.step as f64, 2.0 * f64::from(car), 90.0))
                .collect();
            self.ready = step(self.step as f64 * 0.001, &cars).into_bytes();
            (self.step, self.given) = (self.step + 1, 0);
        }
        let count = out.len().min(self.ready.len() - self.given);
        out[..count].copy_from_slice(&self.ready[self.given..self.given + count]);
        self.given += count;
        Ok(count)
    }
}

#[test]
fn long_files_take_the_memory_of_their_frames() {
    let endless = Endless { step: 0, ready: b"<fcd-export>\n".to_vec(), given: 0 };
    let net = NetLocation { offset_m: DVec2::new(100.0, 50.0), projection: None };
    let place = FcdProjection::new(&town(), &net, false).unwrap();
    // 4 s in steps of a millisecond: about 25 MB of text for nine frames.
    let recorded = read(BufReader::new(endless), &place, &config(), Clock::new(9, 0.5, 0.5), Seed([1; 32])).unwrap();
    assert_eq!(recorded.bodies().len(), 50);
    assert!(recorded.bodies().iter().all(|body| body.states.len() == 9));
}

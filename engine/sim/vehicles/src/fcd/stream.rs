//! The stream of time steps, and the frames between them.

use super::kinds::{kind_of, passenger_car};
use super::lines::Lines;
use super::samples::Sample;
use super::{FcdType, Place};
use cosfly_domain::{Body, BodyPlan};
use cosfly_frames::{DVec2, Seed, TargetState};
use cosfly_world::{Clock, Prescribed};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::io::BufRead;

/// Most bodies in one time step.
const MOST_BODIES: usize = 200_000;
/// Most states of all bodies in all frames.
const MOST_STATES: usize = 20_000_000;
/// Longest name, bytes.
const LONGEST_NAME: usize = 200;
/// A body that moves faster than this between two steps was moved by SUMO (a teleport), m/s.
const JUMP_MPS: f64 = 70.0;
/// From this way on, in metres, that speeds tell, bodies that move less than a share of it have positions of another unit.
const LEAST_TOLD_M: f64 = 50.0;
const LEAST_MOVED_SHARE: f64 = 0.01;
/// Names of unknown types and elements that are kept for the note.
const NAMED_TYPES: usize = 5;

/// How a file of SUMO's floating-car data is read.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FcdConfig {
    /// Time of the file, seconds, at which the first frame lies. Default 0.
    pub begin_s: f64,
    /// Whether positions are degrees: the file was written with `--fcd-output.geo`. Default false.
    pub geo: bool,
    /// Kinds and sizes of types of vehicles by their names; others are told by words in their names.
    pub types: BTreeMap<String, FcdType>,
}

/// Reason why a file cannot be used. `Display` is one fragment with the line.
#[derive(Clone, Debug, PartialEq)]
pub struct FcdError {
    /// The value that was found and the rule it breaks.
    pub message: String,
    /// Line of the file, from 1.
    pub line: Option<u64>,
    /// What the user can do.
    pub hint: Option<String>,
}

impl FcdError {
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), line: None, hint: None }
    }

    fn because(mut self, cause: String) -> Self {
        self.message = format!("{}: {cause}", self.message);
        self
    }

    pub(super) fn at(mut self, line: u64) -> Self {
        self.line = self.line.or(Some(line));
        self
    }

    pub(super) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for FcdError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.message)?;
        self.line.map_or(Ok(()), |line| write!(out, " (line {line})"))
    }
}

impl std::error::Error for FcdError {}

/// Reads the frames of a clock from floating-car data. Reading ends with the last frame.
///
/// # Errors
/// Broken XML, numbers that are none, times that do not grow, a body twice in a step, nothing within the town, more than the memory
/// should hold: each with its line.
pub fn read(
    file: impl BufRead,
    place: &Place,
    config: &FcdConfig,
    clock: Clock,
    seed: Seed,
) -> Result<Prescribed, FcdError> {
    let mut reader = Reader::from_reader(Lines::new(file));
    reader.config_mut().trim_text(true);
    let mut frames = Frames::new(place, config, clock, seed);
    let mut buffer = vec![];
    let mut step: Option<Step> = None;
    let mut is_fcd = false;
    loop {
        buffer.clear();
        let event = reader.read_event_into(&mut buffer);
        let line = reader.get_ref().line;
        let (element, is_empty) = match event.map_err(|error| broken(&error, line))? {
            Event::Start(element) => (element, false),
            Event::Empty(element) => (element, true),
            Event::End(element) if element.name().as_ref() == b"timestep" => {
                if let Some(step) = step.take() {
                    frames.add(step, line)?;
                }
                if frames.is_done() {
                    break;
                }
                continue;
            }
            Event::Eof => break,
            Event::Comment(remark) if !config.geo && says_degrees(&remark) => return Err(degrees(line)),
            _ => continue,
        };
        match element.name().as_ref() {
            b"fcd-export" => is_fcd = true,
            b"timestep" if step.is_some() => {
                return Err(FcdError::new("a `<timestep>` within another one").at(line).hint(WRITE_AGAIN));
            }
            b"timestep" => {
                check_attributes(&element, line)?;
                let time_s = number(&element, "time", line)?;
                let new = Step { time_s, samples: vec![] };
                match is_empty {
                    true => frames.add(new, line)?,
                    false => step = Some(new),
                }
            }
            name @ (b"vehicle" | b"person" | b"container") => {
                let Some(step) = &mut step else {
                    return Err(FcdError::new("a body outside of a `<timestep>`").at(line));
                };
                if step.samples.len() >= MOST_BODIES {
                    return Err(FcdError::new(format!("a time step has more than {MOST_BODIES} bodies")).at(line));
                }
                if name != b"container" && frames.needs(step.time_s) {
                    step.samples.extend(frames.sample(&element, name == b"person", line)?);
                }
            }
            _ if !is_fcd => {
                let error = FcdError::new("the file is no floating-car data: its root is not `<fcd-export>`");
                return Err(error.at(line).hint("write it with `sumo --fcd-output FILE`"));
            }
            name => frames.note_unknown(name),
        }
        if frames.is_done() {
            break;
        }
    }
    frames.finish(is_fcd, step.is_some(), reader.get_ref().line)
}

fn broken(error: &quick_xml::Error, line: u64) -> FcdError {
    FcdError::new(format!("broken XML: {error}")).at(line).hint("write the file again; it may be cut off")
}

/// Whether a remark has the options of a run that wrote degrees, as SUMO puts them at the head of its files.
fn says_degrees(remark: &[u8]) -> bool {
    let remark = String::from_utf8_lossy(remark);
    remark.split("<fcd-output.geo").nth(1).is_some_and(|rest| {
        let option = rest.split('>').next().unwrap_or_default();
        ["true", "1", "yes", "on", "t", "x"].iter().any(|word| option.contains(&format!("value=\"{word}\"")))
    })
}

fn degrees(line: u64) -> FcdError {
    FcdError::new("the positions of the file are degrees, but `geo` is false")
        .at(line)
        .hint("set `geo = true`: the file was written with `--fcd-output.geo`")
}

/// What to do with a file that SUMO does not write.
const WRITE_AGAIN: &str = "write it again with `sumo --fcd-output FILE`, one file a run";

/// A time step of the file.
struct Step {
    time_s: f64,
    samples: Vec<Sample>,
}

/// The frames while they grow.
struct Frames<'a> {
    place: &'a Place,
    config: &'a FcdConfig,
    clock: Clock,
    seed: Seed,
    before: Option<Step>,
    next_frame: u32,
    bodies: Vec<Body>,
    /// Number of the body that a name has now.
    numbers: BTreeMap<String, usize>,
    states: usize,
    outside: usize,
    jumps: usize,
    /// The first types of vehicles of which no kind is known.
    unknown_types: BTreeSet<String>,
    /// Elements of other names: how many, and the first names.
    unknown_elements: (usize, BTreeSet<String>),
    /// Metres that bodies move between steps, and those that their speeds tell.
    moved_m: [f64; 2],
}

impl<'a> Frames<'a> {
    fn new(place: &'a Place, config: &'a FcdConfig, clock: Clock, seed: Seed) -> Self {
        Self {
            place,
            config,
            clock,
            seed,
            before: None,
            next_frame: 0,
            bodies: vec![],
            numbers: BTreeMap::new(),
            states: 0,
            outside: 0,
            jumps: 0,
            unknown_types: BTreeSet::new(),
            unknown_elements: Default::default(),
            moved_m: [0.0; 2],
        }
    }

    fn note_unknown(&mut self, name: &[u8]) {
        let (count, names) = &mut self.unknown_elements;
        *count += 1;
        if names.len() < NAMED_TYPES {
            names.insert(String::from_utf8_lossy(name).chars().take(40).collect());
        }
    }

    fn is_done(&self) -> bool {
        self.next_frame >= self.clock.frames
    }

    /// Time of a frame in the file.
    fn time_s(&self, frame: u32) -> f64 {
        self.config.begin_s + f64::from(frame) * self.clock.dt_s
    }

    /// Whether a time step is of use: steps long before the first frame are not.
    fn needs(&self, time_s: f64) -> bool {
        time_s > self.time_s(self.next_frame) - 60.0
    }

    /// The body of an element; `None` for those far outside of the town.
    fn sample(&mut self, element: &BytesStart<'_>, is_person: bool, line: u64) -> Result<Option<Sample>, FcdError> {
        check_attributes(element, line)?;
        let id = text(element, "id", line)?.ok_or_else(|| FcdError::new("a body has no `id`").at(line))?;
        let type_name = text(element, "type", line)?.unwrap_or_default();
        let known = kind_of(&type_name, is_person, &self.config.types);
        let (kind, size_m) = known.unwrap_or_else(passenger_car);
        if !(size_m.is_finite() && size_m.min_element() > 0.05 && size_m.max_element() < 60.0) {
            let message = format!("the size of type `{type_name}` is {size_m} m; a side is 0.05 to 60 m long");
            return Err(FcdError::new(message).at(line));
        }
        let point = DVec2::new(number(element, "x", line)?, number(element, "y", line)?);
        if self.place.is_geo() && !(point.x.abs() <= 180.0 && point.y.abs() <= 90.0) {
            let message =
                format!("the position `{}, {}` is no longitude and latitude, but `geo` is true", point.x, point.y);
            return Err(FcdError::new(message).at(line).hint("leave out `geo`: it is for files of `--fcd-output.geo`"));
        }
        let angle_deg = number(element, "angle", line)?;
        let speed_mps = number(element, "speed", line)?.max(0.0);
        let mut sample = Sample { id, kind, size_m, middle: DVec2::ZERO, heading_rad: 0.0, speed_mps };
        let is_placed = sample.place(self.place, point, angle_deg, is_person).is_some();
        let is_inside = is_placed && self.place.holds(sample.middle);
        self.outside += usize::from(!is_inside);
        if known.is_none() && is_inside && self.unknown_types.len() < NAMED_TYPES {
            self.unknown_types.insert(type_name);
        }
        Ok(is_inside.then_some(sample))
    }

    /// Takes the next time step: fills the frames up to it.
    fn add(&mut self, mut step: Step, line: u64) -> Result<(), FcdError> {
        step.samples.sort_by(|a, b| a.id.cmp(&b.id));
        if let Some(pair) = step.samples.windows(2).find(|pair| pair[0].id == pair[1].id) {
            return Err(FcdError::new(format!("`{}` is twice in the time step {} s", pair[0].id, step.time_s))
                .at(line)
                .hint(WRITE_AGAIN));
        }
        if let Some(before) = &self.before
            && step.time_s <= before.time_s
        {
            let message = format!("time goes from {} s to {} s; it must grow", before.time_s, step.time_s);
            return Err(FcdError::new(message).at(line).hint(WRITE_AGAIN));
        }
        let before = self.before.take();
        if let Some(before) = &before {
            self.measure(before, &step);
        }
        while !self.is_done() && self.time_s(self.next_frame) <= step.time_s + 1e-6 {
            let frame_s = self.time_s(self.next_frame);
            let at_step = (step.time_s - frame_s).abs() <= 1e-6;
            match &before {
                _ if at_step => self.fill(&step, &step, 0.0, line)?,
                Some(before) if frame_s >= before.time_s => {
                    let share = (frame_s - before.time_s) / (step.time_s - before.time_s);
                    self.fill(before, &step, share, line)?;
                }
                _ => {}
            }
            self.next_frame += 1;
        }
        self.before = Some(step);
        Ok(())
    }

    /// Adds up how far those move who are in both of two steps, and how far by their speeds.
    fn measure(&mut self, from: &Step, to: &Step) {
        let span_s = to.time_s - from.time_s;
        for sample in &from.samples {
            let Ok(place) = to.samples.binary_search_by(|other| other.id.cmp(&sample.id)) else { continue };
            let next = &to.samples[place];
            self.moved_m[0] += (next.middle - sample.middle).length();
            self.moved_m[1] += span_s * 0.5 * (sample.speed_mps + next.speed_mps);
        }
    }

    /// Adds the states of a frame between two steps; those who are in both.
    fn fill(&mut self, from: &Step, to: &Step, share: f64, line: u64) -> Result<(), FcdError> {
        let span_s = to.time_s - from.time_s;
        let mut others = to.samples.iter().peekable();
        for sample in &from.samples {
            while others.peek().is_some_and(|other| other.id < sample.id) {
                others.next();
            }
            let Some(next) = others.peek().filter(|other| other.id == sample.id) else { continue };
            let goes_m = (next.middle - sample.middle).length();
            if goes_m > JUMP_MPS * span_s.max(1e-3) && span_s > 0.0 {
                self.jumps += 1;
                self.numbers.remove(&sample.id);
                continue;
            }
            let state = sample.towards(next, share, self.place);
            self.put(sample, state, line)?;
        }
        Ok(())
    }

    fn put(&mut self, sample: &Sample, state: TargetState, line: u64) -> Result<(), FcdError> {
        self.states += 1;
        if self.states > MOST_STATES {
            let message = format!("the frames hold more than {MOST_STATES} states of bodies");
            return Err(FcdError::new(message).at(line).hint("use fewer frames, or a smaller town"));
        }
        let frame = self.next_frame;
        let known = self.numbers.get(&sample.id).copied();
        // Who was away, or jumped, is a new body: nobody comes back.
        let number = known.filter(|number| {
            let body = &self.bodies[*number];
            let is_jump = body.states.last().is_some_and(|last| {
                (last.feet_in_world - state.feet_in_world).truncate().length() > JUMP_MPS * self.clock.dt_s.max(1e-3)
            });
            self.jumps += usize::from(is_jump && body.end_frame() == frame);
            body.end_frame() == frame && !is_jump
        });
        let number = number.unwrap_or_else(|| {
            let number = self.bodies.len();
            let looks = self.seed.child(&format!("recorded {}", sample.id), 0);
            let (source, kind, size_m) = (sample.id.clone(), sample.kind, sample.size_m);
            let plan = BodyPlan { source, kind, size_m, looks, group: None };
            self.bodies.push(Body { plan, first_frame: frame, states: vec![] });
            self.numbers.insert(sample.id.clone(), number);
            number
        });
        self.bodies[number].states.push(state);
        Ok(())
    }

    fn finish(self, is_fcd: bool, is_cut: bool, line: u64) -> Result<Prescribed, FcdError> {
        if !is_fcd || is_cut && !self.is_done() {
            let what = if is_fcd { "the file ends within a time step" } else { "the file is empty" };
            return Err(FcdError::new(what).at(line).hint(WRITE_AGAIN));
        }
        if self.bodies.is_empty() {
            let (first, last) = (self.time_s(0), self.time_s(self.clock.frames.saturating_sub(1)));
            let error = match self.outside {
                0 => FcdError::new(format!("nobody is in the file between {first} s and {last} s"))
                    .hint("set `begin_s` to a time with traffic"),
                count => FcdError::new(format!("all {count} positions lie outside of the town"))
                    .hint("give the location of the net that the traffic was simulated on; see `geo`, too"),
            };
            return Err(error);
        }
        let [moved_m, told_m] = self.moved_m;
        if !self.config.geo && told_m > LEAST_TOLD_M && moved_m < LEAST_MOVED_SHARE * told_m {
            return Err(degrees(line)
                .because(format!("bodies move by {moved_m:.3} m in all, where their speeds tell {told_m:.0} m")));
        }
        let mut notes = vec![];
        let (count, names) = &self.unknown_elements;
        if *count > 0 {
            let names: Vec<String> = names.iter().map(|name| format!("`<{name}>`")).collect();
            notes.push(format!("{count} elements of other names are left out: {}", names.join(", ")));
        }
        if self.next_frame < self.clock.frames {
            notes.push(format!("the file ends after {} of {} frames", self.next_frame, self.clock.frames));
        }
        for (count, what) in [
            (self.outside, "positions lie far outside of the town and are left out"),
            (self.jumps, "jumps (teleports of SUMO): who jumped goes on as another body"),
        ] {
            if count > 0 {
                notes.push(format!("{count} {what}"));
            }
        }
        if !self.unknown_types.is_empty() {
            let names: Vec<String> = self.unknown_types.iter().map(|name| format!("`{name}`")).collect();
            let names = names.join(", ");
            notes.push(format!(
                "vehicles of types that no word tells are cars; the first: {names}; `types` states kinds"
            ));
        }
        Ok(Prescribed::new(self.bodies, self.clock.dt_s, notes))
    }
}

/// Refuses an element that has an attribute twice.
fn check_attributes(element: &BytesStart<'_>, line: u64) -> Result<(), FcdError> {
    let refused = |error| FcdError::new(format!("broken XML: {error}")).at(line).hint(WRITE_AGAIN);
    element.attributes().try_for_each(|attribute| attribute.map(drop).map_err(refused))
}

/// The text of an attribute.
fn text(element: &BytesStart<'_>, name: &str, line: u64) -> Result<Option<String>, FcdError> {
    let broken = |what: &str| FcdError::new(format!("attribute `{name}` {what}")).at(line);
    let attribute = element.try_get_attribute(name).map_err(|_| broken("cannot be read"))?;
    let Some(attribute) = attribute else { return Ok(None) };
    let raw = core::str::from_utf8(&attribute.value).map_err(|_| broken("is no UTF-8"))?;
    if raw.len() > LONGEST_NAME {
        return Err(broken(&format!("is longer than {LONGEST_NAME} bytes")));
    }
    quick_xml::escape::unescape(raw).map(|text| Some(text.into_owned())).map_err(|_| broken("has a broken escape"))
}

/// A finite number that must be there.
fn number(element: &BytesStart<'_>, name: &str, line: u64) -> Result<f64, FcdError> {
    let own = text(element, name, line)?.ok_or_else(|| {
        let element = String::from_utf8_lossy(element.name().as_ref()).into_owned();
        FcdError::new(format!("`{element}` has no `{name}`")).at(line)
    })?;
    let value = own.trim().parse::<f64>().ok().filter(|value| value.is_finite() && value.abs() < 1e9);
    value.ok_or_else(|| {
        FcdError::new(format!("`{name}` is `{own}`; it must be a number between -1e9 and 1e9"))
            .at(line)
            .hint(WRITE_AGAIN)
    })
}

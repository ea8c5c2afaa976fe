//! Results of `cosfly fly` as the viewer shows them: the episodes of one policy, or of several side by side.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fly::flight::Row;
use cosfly_fly::log::{self, LogLine};
use cosfly_fly::results::{Folder, ending};
use cosfly_read::LogReader;
use cosfly_schema::log::FrameTimes;
use cosfly_view::{FewPoints, Index, ViewSubject, ViewedPicture, inside, short, unknown};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Most policies side by side.
const MOST_POLICIES: usize = 64;

/// Episodes of policies.
pub struct ResultsSubject {
    name: String,
    flights: Vec<Flight>,
}

/// An episode, flown by a policy.
struct Flight {
    folder: PathBuf,
    policy: String,
    row: Row,
}

/// Whether a folder is a result of a policy, or has some.
pub fn is_of_results(path: &Path) -> bool {
    path.join("card.json").is_file() || !policies(path).is_empty()
}

/// Folders of results in a folder, sorted.
fn policies(path: &Path) -> Vec<PathBuf> {
    let entries = path.read_dir().into_iter().flatten().flatten().map(|entry| entry.path());
    let mut found: Vec<PathBuf> = entries.filter(|path| path.join("card.json").is_file()).collect();
    found.sort();
    found.truncate(MOST_POLICIES);
    found
}

impl ResultsSubject {
    /// Opens the result of a policy, or those of all policies in a folder.
    ///
    /// # Errors
    /// `fly-result`, `view-outside`.
    pub fn open(path: &Path) -> Result<Self> {
        let folders = if path.join("card.json").is_file() { vec![path.to_owned()] } else { policies(path) };
        let (mut name, mut flights) = (String::new(), vec![]);
        for folder in folders {
            let inner = folder.strip_prefix(path).unwrap_or(&folder);
            for file in ["card.json", "episodes.jsonl"].map(|file| inner.join(file)) {
                inside(path, &file.to_string_lossy())?;
            }
            let (card, rows) = Folder::read(&folder)?;
            name.clone_from(&card.suite.name);
            let policy = folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            flights.extend(rows.into_iter().map(|row| Flight { folder: folder.clone(), policy: policy.clone(), row }));
        }
        Ok(Self { name, flights })
    }

    fn at(&self, number: usize) -> Result<&Flight> {
        self.flights.get(number).ok_or_else(|| unknown(format!("flight {number}: there are {}", self.flights.len())))
    }
}

impl Flight {
    fn lines(&self) -> Result<Vec<LogLine>> {
        let path = inside(&self.folder, &format!("logs/{}.jsonl", self.row.episode))?;
        let text = std::fs::read_to_string(&path)
            .map_err(|error| Diagnostic::io(format!("read `{}`", path.display()), &error))?;
        log::read(&text)
    }

    /// Mean share of the target that is seen.
    fn visible(&self) -> f64 {
        self.row.score.visible_sum / f64::from(self.row.score.steps.max(1))
    }

    fn reason(&self) -> String {
        let score = &self.row.score;
        let lost = match score.longest_loss_s > 0.0 {
            true => format!(", not tracked for {:.1} s", score.longest_loss_s),
            false => String::new(),
        };
        ending(&self.row) + &lost
    }

    /// The reason with its frames.
    fn reason_at(&self, losses: &[(usize, usize)]) -> String {
        let last = format!(" (frame {})", self.row.score.steps.saturating_sub(1));
        let longest = losses.iter().max_by_key(|(from, end)| (end - from, std::cmp::Reverse(*from)));
        let lost = longest.map_or_else(String::new, |(from, end)| {
            format!(", not tracked for {:.1} s from frame {from}", (end - from) as f64 * self.row.step_s)
        });
        ending(&self.row) + &last + &lost
    }
}

impl ViewSubject for ResultsSubject {
    fn about(&self) -> Result<Value> {
        let (all, version) = (self.flights.len(), "results");
        Ok(
            json!({ "name": self.name, "kind": "result", "version": version, "flights": all, "shown": all, "rejected": 0 }),
        )
    }

    fn index(&self) -> Result<Index> {
        let mut index = Index::default();
        let mut texts = |name: &str, doc: &str, text: &dyn Fn(&Flight) -> String| {
            index.texts(name, doc, self.flights.iter().map(text).collect());
        };
        texts("name", "Episode.", &|it| it.row.episode.clone());
        texts("policy", "Policy.", &|it| it.policy.clone());
        texts("stratum", "Group of the episode.", &|it| it.row.stratum.clone());
        texts("reason", "End in words.", &Flight::reason);
        let mut numbers = |name: &str, doc: &str, number: &dyn Fn(&Flight) -> f64| {
            index.numbers(name, doc, self.flights.iter().map(number));
        };
        numbers("tracking_rate", "Share of the planned steps in which the target was tracked.", &|it| {
            it.row.score.tracking_rate()
        });
        numbers("losses_s", "Longest interval without tracking, seconds.", &|it| it.row.score.longest_loss_s);
        numbers("visible", "Mean share of the target that is seen, 0 to 1.", &Flight::visible);
        numbers("frames", "Steps flown.", &|it| f64::from(it.row.score.steps));
        numbers("duration_s", "Time flown, seconds.", &|it| f64::from(it.row.score.steps) * it.row.step_s);
        let key = |it: &Flight| [-it.row.score.tracking_rate(), it.visible()];
        index.rank(&self.flights.iter().map(key).collect::<Vec<_>>());
        Ok(index)
    }

    fn flight(&self, number: usize) -> Result<Value> {
        let flight = self.at(number)?;
        let lines = flight.lines()?;
        let column = |of: &dyn Fn(&LogLine) -> f64| lines.iter().map(|line| short(of(line))).collect::<Vec<_>>();
        let same = self.flights.iter().enumerate().filter(|(_, other)| other.row.episode == flight.row.episode);
        let family: Vec<Value> = same.map(|(number, it)| json!({ "number": number, "name": it.policy })).collect();
        let losses = losses(&lines);
        let reason = flight.reason_at(&losses);
        let told = |(from, end): (usize, usize)| json!({ "from": from, "end": end, "cause": "not tracked" });
        let losses: Vec<Value> = losses.into_iter().map(told).collect();
        let facts =
            [("policy", flight.policy.clone()), ("stratum", flight.row.stratum.clone()), ("end", ending(&flight.row))];
        let failure = flight.row.policy_failure.iter().map(|words| ("failure", words.clone()));
        Ok(json!({
            "name": flight.row.episode, "reason": reason, "town": flight.row.episode, "dt_s": flight.row.step_s, "family": family,
            "channels": [],
            "facts": facts.into_iter().chain(failure).collect::<Vec<_>>(), "losses": losses, "crossings": [], "captions": [], "goals": [],
            "time_s": column(&|it| it.time_s), "x": column(&|it| it.position_in_world[0]), "y": column(&|it| it.position_in_world[1]),
            "z": column(&|it| it.position_in_world[2]), "camera_yaw_deg": column(&|it| it.yaw_deg),
            "camera_pitch_deg": column(&|it| it.pitch_deg), "target_x": column(&|it| it.target_in_world[0]),
            "target_y": column(&|it| it.target_in_world[1]), "target_z": column(&|it| it.target_in_world[2]),
            "visible": column(&|it| it.visible), "in_view": column(&|it| f64::from(u8::from(it.in_picture))),
            "tracked": column(&|it| f64::from(u8::from(it.tracked))),
        }))
    }

    fn bodies(&self, number: usize) -> Result<Value> {
        self.at(number).map(|_| json!({ "kinds": {}, "boxes": [], "left_out": 0 }))
    }

    fn town(&self, number: usize) -> Result<Value> {
        let flight = self.at(number)?;
        // The log for Foxglove has the town; `--logs` may have left it out.
        let name = format!("logs/{}.mcap", flight.row.episode);
        let boxes = match flight.folder.join(&name).exists() {
            true => LogReader::open(&inside(&flight.folder, &name)?, FrameTimes::default())?.scene()?,
            false => vec![],
        };
        let mut kinds: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for it in boxes {
            let (center, half) = (it.center_in_map, it.half_extents_m);
            // The map's y is minus the world's, and so is its yaw.
            let yaw_deg = -it.yaw_rad.to_degrees();
            let numbers = [center.x, -center.y, half.x, half.y, yaw_deg, 2.0 * half.z, center.z - half.z];
            kinds.entry(it.label.to_lowercase()).or_default().extend(numbers.map(short));
        }
        Ok(json!({ "name": flight.row.episode, "kinds": kinds, "left_out": 0 }))
    }

    fn paths(&self, number: usize) -> Result<Value> {
        let town = &self.at(number)?.row.episode;
        let mut flights = vec![];
        for (place, flight) in self.flights.iter().enumerate().filter(|(_, flight)| flight.row.episode == *town) {
            let lines = flight.lines()?;
            let mut path = FewPoints::of(lines.len());
            lines.iter().for_each(|it| path.add([it.position_in_world[0], it.position_in_world[1], it.visible]));
            flights.push(json!([place, path.numbers()]));
        }
        Ok(json!({ "flights": flights }))
    }

    fn picture(&self, number: usize, _frame: usize, _channel: &str) -> Result<ViewedPicture> {
        let episode = &self.at(number)?.row.episode;
        Err(Diagnostic::new("view-unknown", Fault::Input, format!("the result of `{episode}` has no pictures")))
    }
}

/// Stretches of steps without tracking.
fn losses(lines: &[LogLine]) -> Vec<(usize, usize)> {
    let (mut begin, mut found) = (0, vec![]);
    for part in lines.chunk_by(|a, b| a.tracked == b.tracked) {
        if !part[0].tracked {
            found.push((begin, begin + part.len()));
        }
        begin += part.len();
    }
    found
}

//! `losses`: a table of every time that a target is lost from sight: from when, for how long, behind what.

use cosfly_plugin::{Answer, Column, Flight, Gives, Metadata, Stage, Value, params, reals};

params! {
    /// When a target counts as lost.
    pub struct Params {
        /// Visibility below which the target counts as lost.
        visibility: f64 = 0.5, [0.0, 1.0];
        /// Losses of fewer frames are left out.
        frames: u32 = 1, [1, 1000];
    }
}

/// See the crate.
pub struct Losses(Params);

impl Stage for Losses {
    type Params = Params;

    fn describe() -> Metadata {
        let summary = "A table of every time that a target is lost from sight.";
        Metadata { name: "losses", version: "0.1.0", summary }
    }

    fn new(params: Params) -> Result<Self, String> {
        Ok(Self(params))
    }

    fn reads(&self) -> Vec<Column> {
        let mut columns = reals(["time_s", "visibility"]);
        columns.push(Column::integer("occluder_instance", ""));
        columns
    }

    fn gives(&self) -> Gives {
        let columns = vec![
            Column::integer("first_frame", "the first frame in which it is lost"),
            Column::integer("frames", "how many frames it stays lost"),
            Column::real("begin_s", "time of the first frame"),
            Column::integer("occluder_instance", "what hides it in the first frame, as in `frames`; 0 for nothing"),
            Column::boolean("is_found_again", "whether it is seen again in this flight"),
        ];
        Gives::Rows("losses", columns)
    }

    fn run(&self, flight: &Flight) -> Result<Answer, String> {
        let (times, seen) = (flight.column("time_s")?, flight.column("visibility")?);
        let occluders = flight.integers("occluder_instance")?;
        let is_lost = |frame: usize| seen[frame] < self.0.visibility;
        let mut rows: Vec<Vec<Value>> = vec![];
        let mut frame = 0;
        while frame < flight.len() {
            let end = (frame..flight.len()).find(|later| !is_lost(*later)).unwrap_or(flight.len());
            if end - frame >= self.0.frames as usize && end > frame {
                let row = vec![
                    frame.into(),
                    (end - frame).into(),
                    times[frame].into(),
                    occluders[frame].into(),
                    (end < flight.len()).into(),
                ];
                rows.push(row);
            }
            frame = end + 1;
        }
        Ok(Answer::Rows(rows))
    }
}

cosfly_plugin::stage!(Losses);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_loss_is_a_row() {
        let columns: [(&str, &[f64]); 2] =
            [("time_s", &[0.0, 0.5, 1.0, 1.5, 2.0]), ("visibility", &[1.0, 0.0, 0.2, 1.0, 0.1])];
        let flight = Flight::new("p", &columns).with_integers("occluder_instance", &[0, 7, 7, 0, 9]);
        let rows = |frames: u32| Losses(Params { frames, ..Params::default() }).run(&flight).unwrap();
        let first: Vec<Value> = vec![1_i64.into(), 2_i64.into(), 0.5.into(), 7_i64.into(), true.into()];
        let second: Vec<Value> = vec![4_i64.into(), 1_i64.into(), 2.0.into(), 9_i64.into(), false.into()];
        assert_eq!(rows(1), Answer::Rows(vec![first.clone(), second]));
        assert_eq!(rows(2), Answer::Rows(vec![first]));
    }
}

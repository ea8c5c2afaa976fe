//! `viewpoint`: annotates every flight with where the camera is about its target and how well it keeps it, for choosing flights.

use cosfly_plugin::{Answer, Column, Flight, Gives, Metadata, Stage, libm, params, reals};

params! {
    /// When a target counts as lost.
    pub struct Params {
        /// Visibility below which the target counts as lost.
        visibility: f64 = 0.5, [0.0, 1.0];
    }
}

/// See the crate.
pub struct Viewpoint(Params);

const SIDES: [&str; 4] = ["ahead", "right", "behind", "left"];

impl Stage for Viewpoint {
    type Params = Params;

    fn describe() -> Metadata {
        let summary = "Annotates flights with where the camera is about its target and how well it keeps it.";
        Metadata { name: "viewpoint", version: "0.1.0", summary }
    }

    fn new(params: Params) -> Result<Self, String> {
        Ok(Self(params))
    }

    fn reads(&self) -> Vec<Column> {
        let mut columns =
            reals(["drone_x", "drone_y", "drone_z", "target_x", "target_y", "target_z", "target_heading"]);
        columns.extend(reals(["time_s", "visibility"]));
        columns.push(Column::boolean("in_view", ""));
        columns
    }

    fn gives(&self) -> Gives {
        let columns = vec![
            Column::text(
                "side",
                "where the camera is for most of the time, seen from the target: ahead, right, behind or left",
            ),
            Column::real("mean_distance_m", "from the camera to the feet"),
            Column::real("mean_elevation_deg", "of the camera above the feet's horizon"),
            Column::integer("losses", "how often the target is lost from sight"),
            Column::real("longest_loss_s", "the longest time that it is lost"),
            Column::boolean("always_in_view", "whether the camera is always turned to it"),
            Column::text("instruction", "in English; empty where no captions are connected"),
        ];
        Gives::Annotation("viewpoint", columns)
    }

    fn run(&self, flight: &Flight) -> Result<Answer, String> {
        let of = |name: &str| flight.column(name);
        let drone = [of("drone_x")?, of("drone_y")?, of("drone_z")?];
        let target = [of("target_x")?, of("target_y")?, of("target_z")?];
        let (heading, times, seen) = (of("target_heading")?, of("time_s")?, of("visibility")?);
        let (mut frames_at, mut distance, mut elevation) = ([0_usize; 4], 0.0, 0.0);
        for frame in 0..flight.len() {
            let [x, y, z] = [0, 1, 2].map(|axis| drone[axis][frame] - target[axis][frame]);
            // Seen from above with y to the south, positive angles are to the right.
            let bearing = libm::atan2(y, x) - heading[frame];
            frames_at[libm::rint(bearing / core::f64::consts::FRAC_PI_2).rem_euclid(4.0) as usize] += 1;
            distance += (x * x + y * y + z * z).sqrt();
            elevation += libm::atan2(z, (x * x + y * y).sqrt()).to_degrees();
        }
        let (mut losses, mut longest, mut since) = (0_i64, 0.0_f64, None);
        for (time, visibility) in times.iter().zip(seen) {
            match (*visibility < self.0.visibility, since) {
                (true, None) => {
                    losses += 1;
                    since = Some(*time);
                }
                (false, Some(begin)) => {
                    longest = longest.max(time - begin);
                    since = None;
                }
                _ => {}
            }
        }
        if let (Some(begin), Some(end)) = (since, times.last()) {
            longest = longest.max(end - begin);
        }
        let frames = flight.len().max(1) as f64;
        let most = (0..4).rev().max_by_key(|side| frames_at[*side]).unwrap_or_default();
        Ok(Answer::Row(vec![
            SIDES[most].into(),
            (distance / frames).into(),
            (elevation / frames).into(),
            losses.into(),
            longest.into(),
            flight.booleans("in_view")?.iter().all(|in_view| *in_view).into(),
            flight.instruction("en").unwrap_or_default().into(),
        ]))
    }
}

cosfly_plugin::stage!(Viewpoint);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_behind_its_target_is_found_behind_and_losses_are_counted() {
        let zero = [0.0; 4];
        let columns: Vec<(&str, &[f64])> = vec![
            ("drone_x", &[-3.0; 4]),
            ("drone_y", &zero),
            ("drone_z", &[4.0; 4]),
            ("target_x", &zero),
            ("target_y", &zero),
            ("target_z", &zero),
            ("target_heading", &zero),
            ("time_s", &[0.0, 0.5, 1.0, 1.5]),
            ("visibility", &[1.0, 0.0, 0.2, 1.0]),
        ];
        let flight = Flight::new("p", &columns).with_booleans("in_view", &[true; 4]);
        let Answer::Row(row) = Viewpoint(Params::default()).run(&flight).unwrap() else { panic!("a row") };
        assert_eq!(row[0], "behind".into());
        assert_eq!((&row[1], &row[3], &row[4], &row[5]), (&5.0.into(), &1_i64.into(), &1.0.into(), &true.into()));
    }
}

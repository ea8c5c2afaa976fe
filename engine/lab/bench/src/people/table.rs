//! [`PeopleTable`]: all that is measured of people, printed side by side.

use super::crowds::Crowded;
use super::density::DensityRow;
use super::figures::Figures;
use serde::Serialize;
use std::fmt;

/// All that is measured.
#[derive(Debug, Serialize)]
pub struct PeopleTable {
    /// Figures of each set of tracks.
    pub sets: Vec<Figures>,
    /// Costs of the simulations, and whether they keep their laws.
    pub crowds: Vec<Crowded>,
    /// Speed by density in a ring of pavement.
    pub density: Vec<DensityRow>,
}

impl fmt::Display for PeopleTable {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let row = |out: &mut fmt::Formatter<'_>, name: &str, cell: &dyn Fn(&Figures) -> String| {
            write!(out, "{name:<47}")?;
            self.sets.iter().try_for_each(|set| write!(out, " {:>21}", cell(set)))?;
            writeln!(out)
        };
        row(out, "all at 2 Hz", &|set| set.name.clone())?;
        row(out, "people", &|set| set.people.to_string())?;
        row(out, "walking speed, m/s, median (quartiles)", &|set| {
            let [low, median, high] = set.speed_mps;
            format!("{median:.2} ({low:.2}-{high:.2})")
        })?;
        row(out, "time below 0.2 m/s, %", &|set| format!("{:.1}", 100.0 * set.standing_time))?;
        row(out, "tracks that stand more than half the time, %", &|set| format!("{:.1}", 100.0 * set.standing_tracks))?;
        row(out, "stop length, s, 50 / 95 %", &|set| pair(set.stop_s, 1))?;
        row(out, "peak braking at a stop, m/s2, median", &|set| format!("{:.2}", set.braking_mps2))?;
        row(out, "vector acceleration, m/s2, 50 / 95 %", &|set| pair(set.acceleration_mps2, 2))?;
        row(out, "heading rate, degrees/s, 50 / 95 %", &|set| pair(set.heading_rate_deg_s, 1))?;
        row(out, "samples turning slower than 1 degree/s, %", &|set| format!("{:.0}", 100.0 * set.straight))?;
        row(out, "departure from an 8 s chord, m, 25 / 50 %", &|set| pair(set.departure_m, 2))?;
        row(out, "people in groups, %", &|set| format!("{:.0}", 100.0 * set.in_groups))?;
        row(out, "distance to the nearest companion, m, 50 / 95 %", &|set| pair(set.apart_m, 2))?;
        row(out, "pairs within 3 m that come below 0.4 m, %", &|set| format!("{:.1}", 100.0 * set.close_pairs))?;
        for crowd in &self.crowds {
            writeln!(out, "\n{crowd}")?;
        }
        writeln!(out, "\nSpeed by density on a ring of pavement, m/s (Weidmann 1993: one way)")?;
        let heads = ["people/m2", "one way", "that way, %", "both ways", "Weidmann", "stuck, %"];
        heads.iter().try_for_each(|head| write!(out, "{head:>12}"))?;
        writeln!(out)?;
        self.density.iter().try_for_each(|row| {
            let that_way = 100.0 * row.one_way_share;
            write!(out, "{:>12.2}{:>12.2}{that_way:>12.0}", row.per_m2, row.one_way_mps)?;
            writeln!(out, "{:>12.2}{:>12.2}{:>12.2}", row.both_ways_mps, row.weidmann_mps, 100.0 * row.stuck)
        })
    }
}

fn pair([low, high]: [f64; 2], digits: usize) -> String {
    format!("{low:.digits$} / {high:.digits$}")
}

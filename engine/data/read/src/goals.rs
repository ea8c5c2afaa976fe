//! Goals of all trajectories.

use super::dataset::PublishedDataset;
use cosfly_diagnose::Result;
use cosfly_schema::tables::Goals;
use std::collections::BTreeMap;

/// A row of table `goals`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PublishedGoal {
    /// Kind of goal, such as `step`.
    pub grain: String,
    /// First frame, and the frame after the last one.
    pub frames: [usize; 2],
    /// Lines of the user and the pilot, by turns.
    pub lines: Vec<String>,
    /// Whether the flight does what the goal says.
    pub fits: bool,
    /// Subject of what is not so.
    pub false_subject: Option<String>,
    /// Last words of the user.
    pub claims: Vec<String>,
}

impl PublishedDataset {
    /// Goals in a language by trajectory, in the order of the table; none in a dataset from before the table existed.
    ///
    /// # Errors
    /// Damage of table `goals`.
    pub fn goals(&self, language: &str) -> Result<BTreeMap<String, Vec<PublishedGoal>>> {
        let mut found: BTreeMap<String, Vec<PublishedGoal>> = BTreeMap::new();
        self.each_row("goals", &mut |rows, row| {
            if rows.get(Goals::language, row)? != language {
                return Ok(());
            }
            let frames = [rows.get(Goals::start_frame, row)?, rows.get(Goals::end_frame, row)?];
            found.entry(rows.get(Goals::trajectory_id, row)?).or_default().push(PublishedGoal {
                grain: rows.get(Goals::grain, row)?,
                frames: frames.map(|frame| frame as usize),
                lines: rows.get(Goals::lines, row)?,
                fits: rows.get(Goals::fits, row)?,
                false_subject: rows.get(Goals::false_subject, row)?,
                claims: rows.get(Goals::claims, row)?,
            });
            Ok(())
        })?;
        Ok(found)
    }
}

//! A crowd whose people all walk in a stated direction, as in the experiments that speed is measured by density in.

use crate::crowd::Crowd;
use cosfly_frames::{DVec2, real};

/// So many metres of way lie behind everybody.
const BEHIND_M: u32 = 20;
/// So many metres of way lie ahead, in legs of so many.
const AHEAD_M: u32 = 240;
const LEG_M: u32 = 6;

impl Crowd {
    /// Crowd of these people, who come along the direction that `along` gives for a place, a unit vector, and go on for
    /// 240 m; then they choose goals as others do.
    #[must_use]
    pub fn coming(mut self, along: &dyn Fn(DVec2) -> DVec2) -> Self {
        for company in &mut self.companies {
            let Some(&start) = company.route.last() else { continue };
            let place = self.grid.center(start);
            let behind = (0..BEHIND_M).fold(place, |at, _| at - along(at));
            let Some(behind) = self.grid.node_near(behind, company.piece, 6) else { continue };
            let Some(mut way) = self.search.find(behind, start, &[]) else { continue };
            let progress = way.len() - 1;
            let (mut at, mut last) = (place, start);
            for _ in 0..AHEAD_M / LEG_M {
                at = (0..LEG_M).fold(at, |at, _| at + along(at));
                let leg =
                    self.grid.node_near(at, company.piece, 6).map(|next| (next, self.search.find(last, next, &[])));
                let Some((next, Some(leg))) = leg else { break };
                way.extend(&leg[1..]);
                last = next;
            }
            for person in &mut self.people[company.members.clone()] {
                let ahead = along(person.at);
                person.heading_rad = real::atan2(ahead.y, ahead.x);
                person.progress = progress;
            }
            company.route = way;
        }
        self
    }
}

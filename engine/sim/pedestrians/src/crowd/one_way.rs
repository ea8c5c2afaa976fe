//! A crowd whose people all begin in a stated direction, as in the experiments that speed is measured by density in.

use crate::crowd::Crowd;
use cosfly_frames::{DVec2, real};

/// So many metres of way lie behind everybody: goals are sought ahead of them.
const BEHIND_M: u32 = 20;

impl Crowd {
    /// The same people, who come along the direction that `along` gives for a place, a unit vector, and go on in it.
    #[must_use]
    pub fn coming(mut self, along: &dyn Fn(DVec2) -> DVec2) -> Self {
        for company in &mut self.companies {
            let Some(&start) = company.route.last() else { continue };
            let place = self.grid.center(start);
            let behind = (0..BEHIND_M).fold(place, |at, _| at - along(at));
            let Some(behind) = self.grid.node_near(behind, company.piece, 6) else { continue };
            let Some(way) = self.search.find(behind, start, &[]) else { continue };
            for person in &mut self.people[company.members.clone()] {
                let ahead = along(person.at);
                person.heading_rad = real::atan2(ahead.y, ahead.x);
                person.progress = way.len() - 1;
            }
            company.route = way;
        }
        self
    }
}

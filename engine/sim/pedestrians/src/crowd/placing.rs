//! Where the people of a crowd begin: drawn one company after the other, each on free ground and apart from all before.

use crate::PedestrianError;
use crate::crowd::Crowd;
use crate::crowd::company::{Activity, Company};
use crate::crowd::person::Person;
use crate::goal::{draw_start, roomy_pieces};
use cosfly_frames::{DVec2, RandomStream, Seed, real};
use std::collections::BTreeMap;

/// Gap between bodies at the start, metres.
const APART_M: f64 = 0.1;

/// Attempts to place a company.
const ATTEMPTS: usize = 400;

/// Side of a cell of the register of places, metres.
const CELL_M: f64 = 4.0;

/// Places taken, by cell.
#[derive(Default)]
struct Taken {
    cells: BTreeMap<(i64, i64), Vec<(DVec2, f64)>>,
}

impl Taken {
    fn cells(at: DVec2, reach_m: f64) -> impl Iterator<Item = (i64, i64)> {
        let cell = |place: f64| (place / CELL_M).floor() as i64;
        let (low, high) = (at - reach_m, at + reach_m);
        (cell(low.x)..=cell(high.x)).flat_map(move |x| (cell(low.y)..=cell(high.y)).map(move |y| (x, y)))
    }

    fn is_free(&self, at: DVec2, radius_m: f64) -> bool {
        let is_apart = |(other, other_m): &(DVec2, f64)| (*other - at).length() >= radius_m + other_m + APART_M;
        Self::cells(at, radius_m + APART_M)
            .all(|cell| self.cells.get(&cell).is_none_or(|list| list.iter().all(is_apart)))
    }

    /// Enters a body in all cells that it reaches into.
    fn take(&mut self, at: DVec2, radius_m: f64) {
        Self::cells(at, radius_m).for_each(|cell| self.cells.entry(cell).or_default().push((at, radius_m)));
    }
}

impl Crowd {
    /// Draws and places all people. The first people are the same whatever their number, but for the last company.
    pub(super) fn fill(&mut self, seed: Seed, others: &[(DVec2, f64)]) -> Result<(), PedestrianError> {
        let roomy = roomy_pieces(&self.grid, self.config.min_route_m)?;
        let count = self.config.count as usize;
        let (mut taken, mut groups) = (Taken::default(), 0);
        let others = others.iter().filter(|(at, radius_m)| at.is_finite() && *radius_m < 100.0);
        others.for_each(|(at, radius_m)| taken.take(*at, *radius_m));
        while self.people.len() < count {
            let number = self.companies.len();
            let own = seed.child("company", number as u64);
            let mut stream = own.stream("placing");
            let size = self.draw_size(&mut stream).min(count - self.people.len());
            let first = self.people.len();
            let draw = |member: usize| Person::drawn(&self.config, number, own.child("member", member as u64));
            let mut people: Vec<Person> = (0..size).map(draw).collect();
            let start = (0..ATTEMPTS).find_map(|_| {
                let start = draw_start(&self.grid, &roomy, &mut stream);
                self.place(&mut people, start.1, &taken, &mut stream).then_some(start)
            });
            let Some(start) = start else {
                return Err(PedestrianError::TooCrowded { placed: first, count: self.config.count });
            };
            let group = (size > 1).then_some(groups);
            groups += u32::from(size > 1);
            let mut company = Company::new(first..first + size, group, start, &self.config, own);
            company.cruise_mps = people.iter().map(|person| person.cruise_mps).fold(f64::INFINITY, f64::min);
            if let Some(widest_m) = people.iter().map(|it| it.radius_m).max_by(f64::total_cmp)
                && widest_m > self.config.radius.max_m
            {
                company.abreast_m = company.abreast_m.max(2.0 * widest_m + APART_M);
            }
            if people.iter().any(Person::sits) {
                company.activity = Activity::Standing { until_s: f64::INFINITY };
            }
            let side_m = people[0].side_m;
            for person in &mut people {
                // A company keeps to one line; its members' places are beside each other on it.
                person.side_m = side_m;
                person.z = self.grid.feet_at(person.at).0.z;
                person.pace_mps = if company.activity == Activity::Walking { company.cruise_mps } else { 0.0 };
                taken.take(person.at, person.radius_m);
            }
            self.companies.push(company);
            self.people.append(&mut people);
        }
        Ok(())
    }

    /// Number of people in a company.
    fn draw_size(&self, stream: &mut RandomStream) -> usize {
        let groups = &self.config.groups;
        let total: f64 = groups.sizes.iter().sum();
        let mean: f64 = groups.sizes.iter().zip(2..).map(|(weight, size)| weight / total * f64::from(size)).sum();
        // Share of companies that are groups, so that the asked share of people is in them.
        let share = groups.share / (groups.share + mean * (1.0 - groups.share));
        let (is_group, mut rest) = (stream.chance(share), stream.unit() * total);
        if !is_group {
            return 1;
        }
        for (weight, size) in groups.sizes.iter().zip(2..) {
            if rest < *weight {
                return size;
            }
            rest -= weight;
        }
        groups.sizes.len() + 1
    }

    /// Places the members in a row around a node; false where there is no room.
    fn place(&self, people: &mut [Person], start: u32, taken: &Taken, stream: &mut RandomStream) -> bool {
        let within = 0.5 * self.grid.cell_m;
        let middle =
            self.grid.center(start) + DVec2::new(stream.uniform(-within, within), stream.uniform(-within, within));
        let mut heading_rad = stream.uniform(-real::PI, real::PI);
        if people.iter().any(Person::sits) {
            // Chairs stand at an edge and face away from it.
            let away = self.grid.away_from_edge(self.grid.center(start));
            if away.length() < 0.5 {
                return false;
            }
            heading_rad = real::atan2(away.y, away.x);
        }
        let (sin, cos) = real::sin_cos(heading_rad);
        let first_m = -0.5 * (people.len() - 1) as f64;
        let widest_m = people.iter().map(|person| person.radius_m).fold(self.config.radius.max_m, f64::max);
        for (rank, person) in people.iter_mut().enumerate() {
            let across_m = (first_m + rank as f64) * self.config.groups.abreast_m.max(2.0 * widest_m + APART_M);
            person.place(middle + across_m * DVec2::new(-sin, cos));
            person.heading_rad = heading_rad;
        }
        people.iter().all(|person| {
            self.grid.step_ends_on_ground(self.grid.center(start), person.at)
                && taken.is_free(person.at, person.radius_m)
        })
    }
}

//! Surroundings of the target on its way: landmarks, crossings, people, vehicles.

use super::claim::Said;
use super::course::Course;
use super::{passing, people};
use std::ops::Range;

/// Crossings and landmarks on the way, people who walk along, and people and vehicles that pass the target, in the frames.
pub(super) fn surroundings(course: &Course<'_>, frames: &Range<usize>) -> Vec<Said> {
    let mut found = passing::passed(course, frames);
    found.extend(people::walks_with(course, frames));
    found.extend(passing::crossed(course, frames));
    found.extend(people::passed(course, frames));
    found
}

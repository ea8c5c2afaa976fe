//! [`Junctions`]: who may drive through a junction. A vehicle asks before it enters; it gets its way when all lanes that
//! cross it are free and there is room behind the junction. Who asked first goes first; who finds no room takes another way.

use crate::network::Network;
use crate::vehicle::{BEFORE_JUNCTION_M, STANDING_GAP_M, Vehicle};

/// Vehicles ask from this distance beyond their braking distance, metres.
const ASK_M: f64 = 12.0;
/// Vehicles longer than this need more room where ways bend, metres.
const LONG_M: f64 = 6.5;
/// Who waits longer than this keeps others from going before, seconds.
const PATIENCE_S: f64 = 4.0;

/// Holder of each lane.
#[derive(Clone, Debug)]
pub(crate) struct Junctions {
    /// Number of vehicles that hold each lane, and of long ones.
    held: Vec<u32>,
    held_long: Vec<u32>,
    /// Length that vehicles on their way to each lane, or on it, will take, metres.
    promised_m: Vec<f64>,
    /// Nearest vehicle to the end of each lane that would ask: distance in metres, number.
    nearest: Vec<Option<(f64, usize)>>,
    asking: Vec<usize>,
    requests: Vec<(f64, usize)>,
    /// Lanes of those who wait too long, and of long vehicles among them.
    starving: Vec<u32>,
    starving_long: Vec<u32>,
}

impl Junctions {
    pub fn new(network: &Network) -> Self {
        let lanes = network.lanes.len();
        Self {
            held: vec![0; lanes],
            held_long: vec![0; lanes],
            promised_m: vec![0.0; lanes],
            nearest: vec![None; lanes],
            asking: vec![],
            requests: vec![],
            starving: vec![],
            starving_long: vec![],
        }
    }

    /// Counts a vehicle that begins on a lane outside of junctions.
    pub fn begin(&mut self, vehicle: &Vehicle) {
        self.promised_m[vehicle.route.lanes[0] as usize] += takes_m(vehicle);
    }

    /// Takes back the lanes that a vehicle has left; all of them when it is gone.
    pub fn release(&mut self, network: &Network, vehicle: &mut Vehicle, is_gone: bool) {
        let rear_m = vehicle.way_m - 0.5 * vehicle.length_m();
        let end = if is_gone { vehicle.route.lanes.len() } else { vehicle.route.index(rear_m) };
        for index in vehicle.passage.left..end {
            let lane = vehicle.route.lanes[index] as usize;
            let was_granted = |index: usize| index < vehicle.passage.granted && is_inner(network, vehicle, index);
            if was_granted(index) {
                self.held[lane] = self.held[lane].saturating_sub(1);
                self.held_long[lane] = self.held_long[lane].saturating_sub(u32::from(is_long(vehicle)));
            }
            if index == 0 || !was_granted(index) && was_granted(index - 1) {
                self.promised_m[lane] = (self.promised_m[lane] - takes_m(vehicle)).max(0.0);
            }
        }
        vehicle.passage.left = vehicle.passage.left.max(end);
    }

    /// Grants ways in the order in which they were asked for.
    pub fn grant(&mut self, network: &Network, time_s: f64, vehicles: &mut [Vehicle]) {
        self.requests.clear();
        for (number, vehicle) in vehicles.iter_mut().enumerate().filter(|(_, vehicle)| vehicle.drives()) {
            let Some([first, _]) = next(network, vehicle) else { continue };
            let away_m = vehicle.route.starts_m[first] - vehicle.front_m();
            if away_m < ASK_M + 0.3 * vehicle.speed_mps * vehicle.speed_mps {
                let lane = vehicle.route.lanes[first.saturating_sub(1)] as usize;
                // Only the first vehicle of a lane may ask: nobody waits for one who cannot pass.
                if self.nearest[lane].is_none_or(|(nearest_m, _)| away_m < nearest_m) {
                    self.nearest[lane] = Some((away_m, number));
                }
                self.asking.push(lane);
            }
        }
        for lane in self.asking.drain(..) {
            if let Some((_, number)) = self.nearest[lane].take() {
                let asked_s = *vehicles[number].passage.asked_s.get_or_insert(time_s);
                self.requests.push((asked_s, number));
            }
        }
        self.requests.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        self.starving.clear();
        self.starving_long.clear();
        for request in 0..self.requests.len() {
            let (asked_s, number) = self.requests[request];
            let vehicle = &mut vehicles[number];
            let Some([first, end]) = next(network, vehicle) else { continue };
            let (lanes, exit) = (&vehicle.route.lanes[first..end], vehicle.route.lanes.get(end).copied());
            let has_room = self.has_room(network, exit, takes_m(vehicle));
            if has_room && self.are_free(network, lanes, is_long(vehicle)) {
                for lane in lanes {
                    self.held[*lane as usize] += 1;
                    self.held_long[*lane as usize] += u32::from(is_long(vehicle));
                }
                if let Some(exit) = exit {
                    self.promised_m[exit as usize] += takes_m(vehicle);
                }
                (vehicle.passage.granted, vehicle.passage.asked_s) = (end, None);
            } else if time_s - asked_s > PATIENCE_S {
                if has_room {
                    self.starving.extend(lanes);
                    self.starving_long.extend(lanes.iter().filter(|_| is_long(vehicle)));
                } else {
                    // Who finds no room behind the junction looks for another way: else queues in a circle wait for each other.
                    vehicle.turn_off(network, first);
                    vehicle.passage.asked_s = None;
                }
            }
        }
    }

    /// Whether nobody drives, or waits too long to drive, across lanes.
    fn are_free(&self, network: &Network, lanes: &[u32], is_long: bool) -> bool {
        let is_held = |other: &u32| self.held[*other as usize] > 0;
        let is_held_long = |other: &u32| self.held_long[*other as usize] > 0 || self.starving_long.contains(other);
        lanes.iter().map(|lane| &network.lanes[*lane as usize]).all(|lane| {
            !lane.conflicts.iter().any(|other| is_held(other) || self.starving.contains(other))
                && !lane.long_conflicts.iter().any(|other| is_held_long(other) || is_long && is_held(other))
        })
    }

    /// Whether a vehicle can stand on the lane behind a junction.
    fn has_room(&self, network: &Network, exit: Option<u32>, takes_m: f64) -> bool {
        exit.is_none_or(|exit| {
            let promised_m = self.promised_m[exit as usize];
            promised_m <= 0.0 || promised_m + takes_m + BEFORE_JUNCTION_M < network.lanes[exit as usize].length_m
        })
    }
}

/// Way at which a vehicle must stop: the beginning of lanes that are not granted.
pub(crate) fn stop_m(network: &Network, vehicle: &Vehicle) -> Option<f64> {
    next(network, vehicle).map(|[first, _]| vehicle.route.starts_m[first])
}

/// Whether the rear of a vehicle cuts corners.
fn is_long(vehicle: &Vehicle) -> bool {
    vehicle.length_m() > LONG_M
}

/// Length of a lane that a standing vehicle takes, metres.
fn takes_m(vehicle: &Vehicle) -> f64 {
    vehicle.length_m() + STANDING_GAP_M + 0.5
}

/// Whether a lane of a route is no place to stand: it leads through a junction, or is too short between two of them. Ways over such
/// lanes are granted together, so that nobody waits within a junction for the next one.
fn is_inner(network: &Network, vehicle: &Vehicle, index: usize) -> bool {
    let lane = &network.lanes[vehicle.route.lanes[index] as usize];
    lane.in_junction || lane.length_m < takes_m(vehicle) + BEFORE_JUNCTION_M
}

/// The next lanes of the route that need a grant: first index and the end.
fn next(network: &Network, vehicle: &Vehicle) -> Option<[usize; 2]> {
    let count = vehicle.route.lanes.len();
    let from = vehicle.passage.granted.max(vehicle.route.index(vehicle.way_m));
    let first = (from..count).find(|index| is_inner(network, vehicle, *index))?;
    let end = (first..count).find(|index| !is_inner(network, vehicle, *index)).unwrap_or(count);
    Some([first, end])
}

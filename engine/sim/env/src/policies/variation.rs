//! [`Variation`]: a baseline that acts more weakly, later, earlier or less steadily, for studies of benchmarks.

use super::{Baseline, Knowledge, Policy};
use crate::action::Action;
use crate::environment::Environment;
use cosfly_frames::{DVec3, RandomStream};
use std::collections::VecDeque;

/// Keys of a variation, each with its largest value, sorted.
const KEYS: [(&str, f64); 4] = [("delay_s", 5.0), ("gain", 10.0), ("lead_s", 2.0), ("noise_mps", 20.0)];

/// Changes to the actions of a baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation {
    /// Time by which actions come later; before the first the drone stops. Seconds.
    pub delay_s: f64,
    /// Factor of velocities and of turns of the camera.
    pub gain: f64,
    /// Time by which actions run ahead: they go on as they changed from the one before. Seconds.
    pub lead_s: f64,
    /// Deviation of the noise in each component of the velocity, m/s.
    pub noise_mps: f64,
}

impl Variation {
    /// No change.
    pub const NONE: Self = Self { delay_s: 0.0, gain: 1.0, lead_s: 0.0, noise_mps: 0.0 };

    /// Reads `KEY=VALUE,...`.
    ///
    /// # Errors
    /// Allowed names and ranges, in words.
    pub fn read(text: &str) -> Result<Self, String> {
        let mut read = Self::NONE;
        let keys: Vec<&str> = text.split(',').map(|pair| pair.split('=').next().unwrap_or_default()).collect();
        if let Some((_, twice)) = keys.iter().enumerate().find(|(place, key)| keys[..*place].contains(key)) {
            return Err(format!("`{twice}` is given twice"));
        }
        for pair in text.split(',') {
            let known = |key: &str| KEYS.iter().find(|known| known.0 == key);
            let parts = pair.split_once('=').and_then(|(key, value)| Some((known(key)?, value.parse::<f64>().ok()?)));
            match parts {
                Some(((key, most), value)) if (0.0..=*most).contains(&value) => match *key {
                    "delay_s" => read.delay_s = value,
                    "gain" => read.gain = value,
                    "lead_s" => read.lead_s = value,
                    _ => read.noise_mps = value,
                },
                _ => {
                    let keys = KEYS.map(|(key, most)| format!("{key}=0 to {most}")).join(", ");
                    return Err(format!("`{pair}` changes nothing of a baseline; allowed are {keys}"));
                }
            }
        }
        Ok(read)
    }

    /// The policy of a baseline, changed.
    pub fn of(
        &self,
        baseline: &Baseline,
        environment: &Environment,
        knowledge: &Knowledge,
    ) -> Box<dyn Policy + Send + Sync> {
        let policy = (baseline.make)(environment, knowledge);
        if *self == Self::NONE {
            return policy;
        }
        let stream = environment.episode().seed.stream("variation of a policy");
        Box::new(Varied { policy, change: *self, given: VecDeque::new(), due: Action::default(), before: None, stream })
    }
}

struct Varied {
    policy: Box<dyn Policy + Send + Sync>,
    change: Variation,
    /// Actions that are on their way, with the times at which they were given, seconds.
    given: VecDeque<(f64, Action)>,
    /// The last one that has arrived.
    due: Action,
    /// The action of the policy before the newest, with its time, seconds.
    before: Option<(f64, Action)>,
    stream: RandomStream,
}

impl Varied {
    /// An action, `lead_s` further along its change from the one before.
    fn led(&mut self, now_s: f64, action: Action) -> Action {
        let before = self.before.replace((now_s, action));
        let Some((then_s, before)) = before.filter(|(then_s, _)| now_s > *then_s) else { return action };
        let ahead = self.change.lead_s / (now_s - then_s);
        let mut led = action;
        led.velocity_mps += ahead * (action.velocity_mps - before.velocity_mps);
        led.view.yaw_rad_s += ahead * (action.view.yaw_rad_s - before.view.yaw_rad_s);
        led.view.pitch_rad_s += ahead * (action.view.pitch_rad_s - before.view.pitch_rad_s);
        led
    }
}

impl Policy for Varied {
    fn act(&mut self, environment: &Environment) -> Action {
        let Variation { delay_s, gain, lead_s, noise_mps } = self.change;
        let now_s = environment.observation().time_s;
        let action = self.policy.act(environment);
        let action = if lead_s > 0.0 { self.led(now_s, action) } else { action };
        self.given.push_back((now_s, action));
        while let Some((_, action)) = self.given.pop_front_if(|(given_s, _)| *given_s <= now_s - delay_s + 1e-9) {
            self.due = action;
        }
        let mut action = self.due;
        let noise = DVec3::from_array([0.0; 3].map(|mean| self.stream.normal(mean, noise_mps)));
        action.velocity_mps = gain * action.velocity_mps + noise;
        action.acceleration_mps2 *= gain;
        action.view.yaw_rad_s *= gain;
        action.view.pitch_rad_s *= gain;
        action
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variations_are_read_and_what_is_wrong_is_told() {
        let read = Variation::read("gain=0.5,noise_mps=2,lead_s=0.3").expect("a variation");
        assert_eq!(read, Variation { gain: 0.5, noise_mps: 2.0, lead_s: 0.3, delay_s: 0.0 });
        for text in ["", "gain", "gain=", "gain=-1", "gain=11", "gain=NaN", "lead=1"] {
            let wrong = Variation::read(text).expect_err(text);
            assert!(wrong.contains("delay_s=0 to 5, gain=0 to 10, lead_s=0 to 2, noise_mps=0 to 20"), "{wrong}");
        }
        assert_eq!(Variation::read("gain=1,lead_s=1,gain=2").unwrap_err(), "`gain` is given twice");
    }
}

//! [`VehicleConfig`]: the parameters of simulated vehicles in a recipe, and the rules between them.

use crate::error::VehicleConfigRule;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Simulated vehicles: number, kinds, manner of driving, parked cars.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-gone" = { "speed_deviation": "write `speed_deviation_share`" }))]
pub struct VehicleConfig {
    /// Number of vehicles that drive when the flight begins. Where the lanes have room for fewer, there are fewer, with a note.
    /// Default 60.
    #[schemars(range(min = 0, max = 5_000))]
    pub count: u32,
    /// Shares of the kinds; they need not add up to 1.
    pub mix: MixConfig,
    /// Mean of the drivers' speeds as a share of the limit. Default 0.95.
    #[schemars(range(min = 0.2, max = 1.5))]
    pub speed_share: f64,
    /// Standard deviation of that share between drivers. Default 0.08.
    #[schemars(range(min = 0.0, max = 0.3))]
    pub speed_deviation_share: f64,
    /// Time gap that drivers keep to the vehicle ahead, seconds. Default 1.4.
    #[schemars(range(min = 0.5, max = 5.0))]
    pub headway_s: f64,
    /// Share of the kerbs along which cars are parked, of streets with pavements or a limit of at most 50 km/h: beside lanes where there is
    /// room, else in kerb lanes, which are closed to traffic; a street of one lane each way then has traffic in one direction.
    /// Default 0.3.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub parked_share: f64,
    /// Vehicles begin within this rectangle of the town: smallest x, smallest y, largest x, largest y in the world frame,
    /// metres. Default: the whole town.
    pub area_m: Option<[f64; 4]>,
}

/// Shares of the kinds of vehicles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MixConfig {
    /// Passenger cars. Default 0.68.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub cars: f64,
    /// Vans. Default 0.09.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub vans: f64,
    /// Lorries. Default 0.04.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub trucks: f64,
    /// Buses. Default 0.03.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub buses: f64,
    /// Motorcycles. Default 0.04.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub motorcycles: f64,
    /// Bicycles. Default 0.12.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub bicycles: f64,
    /// Electric scooters, ridden standing. Default 0.
    #[schemars(range(min = 0.0, max = 1.0))]
    #[serde(skip_serializing_if = "is_none")]
    pub e_scooters: f64,
}

/// Whether there are none: the share is not written then, so that it is in no key.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_none(share: &f64) -> bool {
    *share == 0.0
}

impl Default for VehicleConfig {
    fn default() -> Self {
        Self {
            count: 60,
            mix: MixConfig::default(),
            speed_share: 0.95,
            speed_deviation_share: 0.08,
            headway_s: 1.4,
            parked_share: 0.3,
            area_m: None,
        }
    }
}

impl Default for MixConfig {
    fn default() -> Self {
        Self { cars: 0.68, vans: 0.09, trucks: 0.04, buses: 0.03, motorcycles: 0.04, bicycles: 0.12, e_scooters: 0.0 }
    }
}

impl VehicleConfig {
    /// Checks every value.
    ///
    /// # Errors
    /// The first broken rule.
    pub fn validate(&self) -> Result<(), VehicleConfigRule> {
        within(&["count"], f64::from(self.count), 0.0, 5_000.0)?;
        within(&["speed_share"], self.speed_share, 0.2, 1.5)?;
        within(&["speed_deviation_share"], self.speed_deviation_share, 0.0, 0.3)?;
        within(&["headway_s"], self.headway_s, 0.5, 5.0)?;
        within(&["parked_share"], self.parked_share, 0.0, 1.0)?;
        let MixConfig { cars, vans, trucks, buses, motorcycles, bicycles, e_scooters } = self.mix;
        let paths: [&'static [&'static str]; 7] = [
            &["mix", "cars"],
            &["mix", "vans"],
            &["mix", "trucks"],
            &["mix", "buses"],
            &["mix", "motorcycles"],
            &["mix", "bicycles"],
            &["mix", "e_scooters"],
        ];
        let shares = [cars, vans, trucks, buses, motorcycles, bicycles, e_scooters];
        for (path, share) in paths.into_iter().zip(shares) {
            within(path, share, 0.0, 1.0)?;
        }
        if shares.iter().sum::<f64>() <= 0.0 {
            let message = "all shares of `mix` are 0; at least one must be larger".to_owned();
            return Err(VehicleConfigRule { path: &["mix"], message });
        }
        if let Some(area @ [left, top, right, bottom]) = self.area_m
            && !(area.iter().all(|edge| edge.is_finite()) && left < right && top < bottom)
        {
            let message = format!("`area_m` is `{area:?}`; it must be smallest x, smallest y, largest x, largest y");
            return Err(VehicleConfigRule { path: &["area_m"], message });
        }
        Ok(())
    }
}

fn within(path: &'static [&'static str], value: f64, min: f64, max: f64) -> Result<(), VehicleConfigRule> {
    let name = path.last().copied().unwrap_or_default();
    if (min..=max).contains(&value) {
        return Ok(());
    }
    Err(VehicleConfigRule { path, message: format!("`{name}` is `{value}`; it must be within `{min}` and `{max}`") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_out_of_range_are_refused_by_name() {
        let refusal = |change: fn(&mut VehicleConfig)| {
            let mut config = VehicleConfig::default();
            change(&mut config);
            config.validate().err().map(|rule| (rule.path.join("."), rule.message))
        };
        assert_eq!(refusal(|_| ()), None);
        assert_eq!(refusal(|it| it.headway_s = f64::NAN).unwrap().0, "headway_s");
        assert_eq!(refusal(|it| it.mix.buses = -1.0).unwrap().0, "mix.buses");
        let none = MixConfig {
            cars: 0.0,
            vans: 0.0,
            trucks: 0.0,
            buses: 0.0,
            motorcycles: 0.0,
            bicycles: 0.0,
            e_scooters: 0.0,
        };
        assert!(VehicleConfig { mix: none, ..VehicleConfig::default() }.validate().is_err());
        assert_eq!(refusal(|it| it.area_m = Some([0.0, 0.0, -1.0, 5.0])).unwrap().0, "area_m");
    }
}

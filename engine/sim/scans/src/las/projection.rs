//! [`Projection`]: units and name of a LAS file's coordinates, from its well-known text or its GeoTIFF keys.

use super::header::Header;
use super::wkt::{self, Units};
use crate::cloud::points::PROJECT_FIRST;
use cosfly_town::{MapError, units};

/// User of the records about the projection.
const USER: &str = "LASF_Projection";
/// Numbers of the records: well-known text, GeoTIFF keys, their real numbers, their texts.
const WKT: u16 = 2112;
const KEYS: u16 = 34735;
const REALS: u16 = 34736;
const TEXTS: u16 = 34737;
/// GeoTIFF keys: kind of model, citations, code, unit of the plan (code, or length in metres), code and unit of the height.
const MODEL: u16 = 1024;
const CITATION: u16 = 1026;
const PLAN_CODE: u16 = 3072;
const PLAN_CITATION: u16 = 3073;
const PLAN_UNIT: u16 = 3076;
const PLAN_UNIT_M: u16 = 3077;
const HEIGHT_CODE: u16 = 4096;
const HEIGHT_UNIT: u16 = 4099;
/// Values of the kind of model for angles and for places about the Earth's centre, and of a code that the file does not give.
const ANGLES: u16 = 2;
const CENTRIC: u16 = 3;
const NO_CODE: u16 = 32767;
/// International foot, metres.
const FOOT_M: f64 = 0.3048;
/// Foot of surveys in the United States, metres.
const SURVEY_FOOT_M: f64 = 1200.0 / 3937.0;

/// Units and name of the coordinates.
#[derive(Clone, Debug, Default)]
pub struct Projection {
    units: Units,
    /// Code of a unit of the plan that is not known.
    unknown_unit: Option<u16>,
    /// The file's own words: well-known text, else a citation or code.
    pub text: Option<String>,
}

impl Projection {
    /// Reads what the file says, which may be nothing.
    ///
    /// # Errors
    /// Coordinates that are angles.
    pub fn read(header: &Header<'_>) -> Result<Self, MapError> {
        let text = header.only_record(USER, WKT)?.map(until_zero).filter(|text| !text.is_empty());
        let by_text = text.as_deref().map(wkt::units).unwrap_or_default();
        let keys = Keys::read(header)?;
        let by_keys = keys.units();
        let units = Units {
            plan_m: by_text.plan_m.or(by_keys.plan_m),
            height_m: by_text.height_m.or(by_keys.height_m),
            is_geographic: by_text.is_geographic || (text.is_none() && by_keys.is_geographic),
        };
        if units.is_geographic {
            let error = MapError::new("the coordinates of the cloud are degrees of longitude and latitude");
            return Err(error.hint(PROJECT_FIRST));
        }
        if text.as_deref().is_some_and(wkt::is_centric) || keys.code(MODEL) == Some(CENTRIC) {
            let error = MapError::new("the coordinates of the cloud are counted from the centre of the Earth");
            return Err(error.hint(PROJECT_FIRST));
        }
        Ok(Self { units, unknown_unit: keys.unknown_unit(), text: text.or_else(|| keys.name()) })
    }

    /// Length of the units of plan and height, metres: as the user says, else as the file says, else metres. A file that
    /// states one unit alone means it for both.
    ///
    /// # Errors
    /// A unit that is not known.
    pub fn units_m(&self, asked_m: Option<f64>, warnings: &mut Vec<String>) -> Result<[f64; 2], MapError> {
        if let Some(unit_m) = asked_m {
            return Ok([unit_m; 2]);
        }
        if let (None, Some(code)) = (self.units.plan_m, self.unknown_unit) {
            let error = MapError::new(format!("the unit of the coordinates has the code {code}, which is not known"));
            return Err(error.hint("give its length in metres with `options.unit_m`"));
        }
        let plan_m = self.units.plan_m.unwrap_or(1.0);
        let height_m = self.units.height_m.unwrap_or(plan_m);
        if self.units.plan_m.is_none() {
            warnings.push(
                "the file does not state the unit of its coordinates: metres are assumed (`options.unit_m` tells another)"
                    .to_owned(),
            );
        }
        warnings.extend(units::unit_warning(plan_m, self.text.as_deref()));
        Ok([plan_m, height_m])
    }
}

fn until_zero(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).trim().to_owned()
}

/// GeoTIFF keys with their values.
#[derive(Default)]
struct Keys<'a> {
    keys: Vec<[u16; 4]>,
    reals: &'a [u8],
    texts: &'a [u8],
}

impl<'a> Keys<'a> {
    fn read(header: &Header<'a>) -> Result<Self, MapError> {
        let data = header.only_record(USER, KEYS)?.unwrap_or_default();
        let number = |bytes: &[u8]| u16::from_le_bytes([bytes[0], bytes[1]]);
        let key = |bytes: &[u8]| [0, 2, 4, 6].map(|at| number(&bytes[at..]));
        // The first entry is the head of the others.
        let keys = data.chunks_exact(8).skip(1).map(key).collect();
        let [reals, texts] = [REALS, TEXTS].map(|record| header.record(USER, record).unwrap_or_default());
        Ok(Self { keys, reals, texts })
    }

    /// Code of a unit of the plan that is in no list, where the file states no length either.
    fn unknown_unit(&self) -> Option<u16> {
        self.code(PLAN_UNIT).filter(|code| *code != NO_CODE && *code != 0 && unit_m(*code).is_none())
    }

    fn code(&self, key: u16) -> Option<u16> {
        self.keys.iter().find(|[id, place, ..]| *id == key && *place == 0).map(|[.., value]| *value)
    }

    fn real(&self, key: u16) -> Option<f64> {
        let [.., index] = self.keys.iter().find(|[id, place, ..]| *id == key && *place == REALS)?;
        let bytes = self.reals.get(8 * usize::from(*index)..)?.first_chunk()?;
        Some(f64::from_le_bytes(*bytes))
    }

    fn text(&self, key: u16) -> Option<String> {
        let [.., count, start] = self.keys.iter().find(|[id, place, ..]| *id == key && *place == TEXTS)?;
        let bytes = self.texts.get(usize::from(*start)..)?;
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min((*count).into())])
            .trim_end_matches(['|', '\0'])
            .trim()
            .to_owned();
        Some(text).filter(|text| !text.is_empty())
    }

    fn units(&self) -> Units {
        let named = || {
            let name =
                format!("{} {}", self.text(CITATION).unwrap_or_default(), self.text(PLAN_CITATION).unwrap_or_default());
            let name = name.to_lowercase();
            let is_survey_foot =
                ["ftus", "us survey foot", "us survey feet", "us-ft"].iter().any(|word| name.contains(word));
            let is_foot = ["(ft)", "foot", "feet"].iter().any(|word| name.contains(word));
            if is_survey_foot { Some(SURVEY_FOOT_M) } else { is_foot.then_some(FOOT_M) }
        };
        let stated_m = || self.real(PLAN_UNIT_M).filter(|length| (1e-6..=1000.0).contains(length));
        let of_code = || self.code(PLAN_CODE).filter(|code| *code != NO_CODE).map(|code| units::unit_m(code.into()));
        Units {
            plan_m: self.code(PLAN_UNIT).and_then(unit_m).or_else(stated_m).or_else(named).or_else(of_code),
            height_m: self.code(HEIGHT_UNIT).and_then(unit_m).or_else(|| {
                let code = self.code(HEIGHT_CODE).filter(|code| *code != NO_CODE && *code != 0);
                code.map(|code| units::height_unit_m(code.into()))
            }),
            is_geographic: self.code(MODEL) == Some(ANGLES),
        }
    }

    fn name(&self) -> Option<String> {
        let code = self.code(PLAN_CODE).filter(|code| *code != NO_CODE);
        code.map(|code| format!("EPSG:{code}")).or_else(|| self.text(PLAN_CITATION)).or_else(|| self.text(CITATION))
    }
}

/// Length of a unit of EPSG's list, metres.
fn unit_m(code: u16) -> Option<f64> {
    match code {
        9001 => Some(1.0),
        9002 => Some(FOOT_M),
        9003 => Some(SURVEY_FOOT_M),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_alone_tells_the_unit() {
        for (code, unit) in [(2263, SURVEY_FOOT_M), (2222, FOOT_M), (2154, 1.0)] {
            let keys = Keys { keys: vec![[PLAN_CODE, 0, 1, code]], ..Keys::default() };
            assert_eq!(keys.units().plan_m, Some(unit), "{code}");
        }
        // A plan in metres with heights in feet.
        let keys = Keys { keys: vec![[PLAN_CODE, 0, 1, 26918], [HEIGHT_CODE, 0, 1, 6360]], ..Keys::default() };
        assert_eq!((keys.units().plan_m, keys.units().height_m), (Some(1.0), Some(SURVEY_FOOT_M)));
        let keys = Keys { keys: vec![[PLAN_UNIT, 0, 1, 9036]], ..Keys::default() };
        assert_eq!((keys.units().plan_m, keys.unknown_unit()), (None, Some(9036)));
    }
}

//! Parameters of the `dataset` stage: name, licence, splits, windows, image encodings.

use crate::card_text::{FACTS, unknown_fact};
use cosfly_diagnose::ParameterError;
use cosfly_windows::WindowShape;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

pub use crate::split_config::{AreaCut, CutAxis, OverlapDirection, SplitBy, SplitShares};

/// Parameters of the `dataset` stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DatasetConfig {
    /// Short name: letters, digits, `-` and `_`; also the name in `croissant.json`.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,95}$"))]
    pub name: String,
    /// Title of the card. `{towns}`, `{targets}`, `{pedestrians}`, `{flights}`, `{frames}` and `{minutes}` stand for the facts
    /// of the dataset, such as `Town02`, `4 targets`, `4 pedestrians`, `8 flights`, `1600 frames` and `13.3 minutes`.
    pub title: String,
    /// Description of the dataset, one paragraph, for the card and `croissant.json`, with facts in braces as in `title`.
    #[schemars(length(min = 1))]
    pub description: String,
    /// Version of the data, `MAJOR.MINOR.PATCH`.
    #[schemars(regex(pattern = r"^(0|[1-9][0-9]*)\.(0|[1-9][0-9]*)\.(0|[1-9][0-9]*)$"))]
    pub version: String,
    /// Licence of the generated data (not of cosfly).
    pub license: LicenseConfig,
    /// Publisher of the dataset.
    pub creator: CreatorConfig,
    /// Web address of the dataset.
    #[schemars(length(min = 1))]
    pub url: String,
    /// Citation (BibTeX); empty writes an entry from the title, creator and year.
    pub citation: String,
    /// Day of publication, `YYYY-MM-DD`; a parameter, because equal recipes must give equal bytes.
    #[schemars(regex(pattern = r"^[0-9]{4}-(0[1-9]|1[0-2])-(0[1-9]|[12][0-9]|3[01])$"))]
    pub date_published: String,
    /// Shares of train, validation and test, and groups that must stay together.
    pub splits: SplitShares,
    /// Shape of training windows: table `windows`.
    pub windows: WindowConfig,
    /// Texts for single terms of the Responsible AI vocabulary, such as `dataBiases`, instead of the generated ones.
    pub responsible_ai: BTreeMap<String, String>,
    /// Rows of the `frames` table in one Parquet file; larger tables are split into several files.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub frames_per_file: u32,
    /// Walks whose flights share files of tables: further walks write files of their own and change no earlier one, unless
    /// splits move.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub walks_per_file: u32,
}

impl Default for DatasetConfig {
    fn default() -> Self {
        Self {
            name: "cosfly-dataset".into(),
            title: "Aerial tracking flights in {towns}".into(),
            description: "{flights} of a simulated drone that keeps a moving target in view between buildings and trees, behind {targets} in {towns}: trajectories \
                          with RGB, metric depth, semantic and instance images, 6-DoF camera poses, target states and bilingual instructions.".into(),
            version: "1.0.0".into(),
            license: LicenseConfig::default(),
            creator: CreatorConfig::default(),
            url: "https://example.org/cosfly-dataset".into(),
            citation: String::new(),
            date_published: "2026-01-01".into(),
            splits: SplitShares::default(),
            windows: WindowConfig::default(),
            responsible_ai: BTreeMap::new(),
            frames_per_file: 20_000,
            walks_per_file: 200,
        }
    }
}

impl DatasetConfig {
    /// Parameters that only parts read which write tables; not in the key of the dataset itself.
    pub const NOT_IN_KEY: &[&str] = &["windows", "frames_per_file", "walks_per_file"];

    /// Checks the rules that the schema cannot express.
    pub fn check(&self) -> Result<(), ParameterError> {
        let shares = [self.splits.train, self.splits.val, self.splits.test];
        if !(shares.iter().all(|share| *share >= 0.0) && shares.iter().sum::<f64>() > 0.0) {
            return Err(ParameterError {
                path: vec!["splits".into()],
                message: format!("the shares are {shares:?}; none may be negative and one must be more than 0"),
                hint: Some(
                    "to put everything into one split: `splits = { train = 1.0, val = 0.0, test = 0.0 }`".into(),
                ),
            });
        }
        if let Some((town, message)) = self.splits.area_problem() {
            return Err(ParameterError {
                path: vec!["splits".into(), "areas".into(), town.clone()],
                message,
                hint: Some("such as `{ axis = \"x\", splits = [\"train\", \"test\"], at_m = [120.0] }`".into()),
            });
        }
        if self.splits.has_idle_guard() {
            return Err(ParameterError {
                path: vec!["splits".into(), "guard_m".into()],
                message: "a guard band has a meaning with `by = \"area\"` only".to_owned(),
                hint: Some("remove `guard_m`, or split by area of the map".into()),
            });
        }
        let windows = &self.windows;
        if windows.history >= windows.size {
            return Err(ParameterError {
                path: vec!["windows".into(), "history".into()],
                message: format!(
                    "`history` is `{}` of `{}` frames: nothing is left to predict",
                    windows.history, windows.size
                ),
                hint: Some("it must be less than `size`".into()),
            });
        }
        if !is_day(&self.date_published) {
            return Err(ParameterError {
                path: vec!["date_published".into()],
                message: format!("`{}` is not a day of the calendar", self.date_published),
                hint: Some("write it as `YYYY-MM-DD`, such as `2026-01-31`".into()),
            });
        }
        for (key, text) in [("title", &self.title), ("description", &self.description)] {
            if let Some(name) = unknown_fact(text) {
                let names: Vec<String> = FACTS.iter().map(|(name, _)| format!("`{{{name}}}`")).collect();
                return Err(ParameterError {
                    path: vec![key.into()],
                    message: format!("`{{{name}}}` is not a fact of datasets"),
                    hint: Some(format!("facts are {}", names.join(", "))),
                });
            }
        }
        let known = RESPONSIBLE_AI_TERMS;
        match self.responsible_ai.keys().find(|term| !known.contains(&term.as_str())) {
            None => Ok(()),
            Some(term) => Err(ParameterError {
                path: vec!["responsible_ai".into(), term.clone()],
                message: format!("`{term}` is not a term of the Responsible AI vocabulary"),
                hint: Some(match cosfly_diagnose::nearest_name(term, known) {
                    Some(nearest) => format!("did you mean `{nearest}`?"),
                    None => format!("the terms are {}", known.join(", ")),
                }),
            }),
        }
    }
}

/// Terms of the vocabulary whose text a recipe may replace (`responsible_ai` of the dataset's parameters).
pub const RESPONSIBLE_AI_TERMS: [&str; 20] = [
    "annotationsPerItem",
    "annotatorDemographics",
    "dataAnnotationAnalysis",
    "dataAnnotationPlatform",
    "dataAnnotationProtocol",
    "dataBiases",
    "dataCollection",
    "dataCollectionMissingData",
    "dataCollectionRawData",
    "dataCollectionTimeframe",
    "dataCollectionType",
    "dataImputationProtocol",
    "dataLimitations",
    "dataManipulationProtocol",
    "dataPreprocessingProtocol",
    "dataReleaseMaintenancePlan",
    "dataSocialImpact",
    "dataUseCases",
    "machineAnnotationTools",
    "personalSensitiveInformation",
];

/// Whether a date of the form `YYYY-MM-DD` is in the Gregorian calendar.
fn is_day(date: &str) -> bool {
    let parts: Vec<u32> = date.split('-').filter_map(|part| part.parse().ok()).collect();
    let [year, month, day] = parts[..] else { return false };
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = match month {
        2 => 28 + u32::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => 0,
    };
    year > 0 && (1..=days).contains(&day)
}

/// Licence of the data. By default cosfly's own terms: free for all, but not for unauthorised surveillance and not for
/// military targeting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LicenseConfig {
    /// SPDX name in lower case as Hugging Face lists it, such as `cc-by-4.0`, or any other name.
    pub name: String,
    /// Address of the licence's text.
    #[schemars(length(min = 1))]
    pub url: String,
    /// Content of the `LICENSE` file; empty writes cosfly's own terms under their default name, and name and address of
    /// any other licence.
    pub text: String,
    /// Prohibited uses of the data: section "Responsible use" of the card and `usageInfo` of `croissant.json`, whatever
    /// the licence.
    #[schemars(length(min = 1))]
    pub responsible_use: String,
}

/// Name of cosfly's own terms.
pub const OWN_LICENSE: &str = "cosfly-responsible-use-1.0";

impl Default for LicenseConfig {
    fn default() -> Self {
        Self {
            name: OWN_LICENSE.into(),
            url: "LICENSE".into(),
            text: String::new(),
            responsible_use:
                "These data, and models trained on them, may not be used to build, test or operate systems \
                              for the unauthorised surveillance of people, nor for military targeting."
                    .into(),
        }
    }
}

/// Publisher of a dataset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CreatorConfig {
    /// Person or organisation.
    pub name: String,
    /// Web address of the publisher.
    pub url: String,
}

impl Default for CreatorConfig {
    fn default() -> Self {
        Self { name: "A user of cosfly".into(), url: "https://example.org".into() }
    }
}

/// Shape of training windows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct WindowConfig {
    /// Number of frames of a window.
    #[schemars(range(min = 2, max = 1000))]
    pub size: u32,
    /// Number of frames that a model sees, at the start of the window; the last of them is the current frame. Less than
    /// `size`.
    #[schemars(range(min = 1, max = 999))]
    pub history: u32,
    /// Number of frames from the start of a window to the start of the next one.
    #[schemars(range(min = 1, max = 1000))]
    pub stride: u32,
}

impl Default for WindowConfig {
    fn default() -> Self {
        Self { size: 10, history: 5, stride: 3 }
    }
}

impl WindowConfig {
    /// Shape of the windows.
    pub fn shape(&self) -> WindowShape {
        WindowShape {
            history: self.history as usize,
            horizon: self.size.saturating_sub(self.history) as usize,
            stride: self.stride as usize,
        }
    }
}

/// Storage of images; part of the `render` stage's parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EncodingConfig {
    /// Colour images: `jpeg` (small) or `png` (lossless).
    pub rgb: RgbEncoding,
    /// Quality of JPEG images.
    #[schemars(range(min = 50, max = 100))]
    pub jpeg_quality: u8,
    /// Resolution of the colours of JPEG images beside that of their brightness: `full` (4:4:4) or `half` (4:2:0).
    pub jpeg_chroma: JpegChroma,
    /// Depth images: `grid` (rounded to 2^-10 m, about six times smaller) or `lossless`.
    pub depth: DepthEncoding,
    /// Whether small previews of all channels are stored, for viewers and the `frames` table.
    pub previews: bool,
}

impl Default for EncodingConfig {
    fn default() -> Self {
        Self {
            rgb: RgbEncoding::Jpeg,
            jpeg_quality: 90,
            jpeg_chroma: JpegChroma::Half,
            depth: DepthEncoding::Grid,
            previews: true,
        }
    }
}

/// Storage of colour images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RgbEncoding {
    /// JPEG.
    Jpeg,
    /// Lossless PNG.
    Png,
}

/// Resolution of the colours of JPEG images beside that of their brightness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JpegChroma {
    /// Full resolution (4:4:4).
    Full,
    /// Half in both directions (4:2:0).
    Half,
}

/// Storage of depth images; always 32-bit floats in metres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DepthEncoding {
    /// Rounded to multiples of 2^-10 m (error at most 0.49 mm), so that they compress well.
    Grid,
    /// Unrounded.
    Lossless,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_day_that_no_calendar_has_is_refused() {
        for (date, holds) in [
            ("2026-02-28", true),
            ("2024-02-29", true),
            ("2026-02-29", false),
            ("2026-06-31", false),
            ("2026-13-01", false),
        ] {
            let config = DatasetConfig { date_published: date.into(), ..DatasetConfig::default() };
            assert_eq!(config.check().is_ok(), holds, "{date}");
        }
    }

    #[test]
    fn a_mistyped_term_and_shares_without_any_are_refused_with_their_place() {
        assert_eq!(DatasetConfig::default().check(), Ok(()));
        let mut config = DatasetConfig::default();
        config.responsible_ai.insert("dataBias".into(), "none".into());
        let error = config.check().unwrap_err();
        assert_eq!(error.path, ["responsible_ai", "dataBias"]);
        assert_eq!(error.hint.unwrap(), "did you mean `dataBiases`?");
        let splits = SplitShares { train: 0.0, val: 0.0, test: 0.0, ..SplitShares::default() };
        assert_eq!(DatasetConfig { splits, ..DatasetConfig::default() }.check().unwrap_err().path, ["splits"]);
    }
}

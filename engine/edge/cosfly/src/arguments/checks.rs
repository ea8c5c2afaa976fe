//! Commands that look at finished data: verify, doctor, preview.

use super::StoreArguments;
use clap::Args;
use cosfly_preview::FrameList;
use std::path::PathBuf;

/// Arguments of `verify`.
#[derive(Args, Debug)]
pub struct VerifyArguments {
    /// Folder of the dataset
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Make so many flights anew from the recipe alone, in an empty store, and compare their logs byte by byte
    #[arg(long, value_name = "N")]
    pub regenerate: Option<u16>,
    /// The recipe for `--regenerate` [default: that of the named version that has these files]
    #[arg(long, value_name = "RECIPE", requires = "regenerate")]
    pub recipe: Option<PathBuf>,
    /// Change a value of that recipe (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE", requires = "recipe")]
    pub overrides: Vec<String>,
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Arguments of `doctor`.
#[derive(Args, Debug)]
pub struct DoctorArguments {
    /// Folder of the data
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Share of imperfect episodes that does no harm, percent
    #[arg(long, value_name = "PERCENT", default_value_t = 5.0)]
    pub imperfect: f64,
    /// Share of episodes, percent, that lose their target for a time between two lengths in seconds (repeatable)
    #[arg(long = "quota", value_name = "PERCENT:FROM-TO", value_parser = quota)]
    pub quotas: Vec<cosfly_doctor::Quota>,
    /// Write everything that was found as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

fn quota(text: &str) -> Result<cosfly_doctor::Quota, String> {
    let parts = text.split_once(':').and_then(|(share, times)| Some((share, times.split_once('-')?)));
    let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite() && *number >= 0.0);
    let numbers = parts.and_then(|(share, (from, to))| Some((number(share)?, number(from)?, number(to)?)));
    match numbers {
        Some((percent, from, to)) if percent <= 100.0 && from <= to => {
            Ok(cosfly_doctor::Quota { wanted: percent / 100.0, lost_s: (from, to) })
        }
        _ => Err("it must be a percentage, a colon and two times in seconds, such as 20:2-4".to_owned()),
    }
}

/// Arguments of `preview`.
#[derive(Args, Debug)]
pub struct PreviewArguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    pub dir: PathBuf,
    /// The flight to draw, such as expert-p00000 [default: the first one]
    #[arg(long, value_name = "ID")]
    pub trajectory: Option<String>,
    /// Frames to show, such as 0,50,100 or 0..200:10
    #[arg(long, value_name = "LIST")]
    pub frames: Option<FrameList>,
    /// Folder for the pictures [default: <DATASET>-preview]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

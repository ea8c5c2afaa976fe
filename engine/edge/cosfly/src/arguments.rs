//! Arguments that several commands have: the recipe, the store, values in a range.

use crate::command::Refusals;
use crate::console::Console;
use crate::recipe_file;
use clap::Args;
use clap::builder::{PathBufValueParser, TypedValueParser};
use cosfly_diagnose::Diagnostic;
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;
use cosfly_store::{Remote, Store};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A recipe with changes to it.
#[derive(Args, Clone, Debug)]
pub struct RecipeArguments {
    /// The recipe (TOML), or a folder with a recipe.toml; - for standard input, with files relative to the current folder
    #[arg(value_name = "RECIPE")]
    pub recipe: PathBuf,
    /// Change a value of the recipe, such as stages.expert.weights.visibility=5 (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
}

impl RecipeArguments {
    /// The checked recipe with its changes.
    ///
    /// # Errors
    /// All errors of the recipe.
    pub fn load(&self, console: &dyn Console) -> Result<Recipe, Refusals> {
        let recipe = self.read(console)?;
        crate::town_names::check(&recipe)?;
        Ok(recipe)
    }

    fn read(&self, console: &dyn Console) -> Result<Recipe, Refusals> {
        if self.recipe != Path::new("-") {
            return Ok(recipe_file::load(&self.recipe, &self.overrides)?);
        }
        let registry = cosfly_stages::registry();
        let mut text = String::new();
        let read = console.input().read_to_string(&mut text);
        read.map_err(|error| Diagnostic::io("read standard input", &error))?;
        Ok(cosfly_recipe::read(Path::new("standard input"), &text, &self.overrides, &registry)?)
    }
}

/// Place of the store.
#[derive(Args, Clone, Debug)]
pub struct StoreArguments {
    /// Folder of the store, or s3://BUCKET/PREFIX [default: $COSFLY_STORE, else .cosfly in the current folder]
    #[arg(long, value_name = "DIR", env = "COSFLY_STORE", hide_env = true)]
    pub store: Option<PathBuf>,
}

impl StoreArguments {
    /// The store's folder; of a bucket, the folder on this machine that is its cache.
    pub fn folder(&self) -> PathBuf {
        let Some(place) = self.bucket() else { return self.store.clone().unwrap_or_else(|| PathBuf::from(".cosfly")) };
        let cache = std::env::var_os("COSFLY_CACHE").filter(|folder| !folder.is_empty()).map(PathBuf::from);
        let name = format!("cosfly-{}", Digest::of(place.as_bytes()).short());
        cache.unwrap_or_else(std::env::temp_dir).join(name)
    }

    /// The bucket, where the store is in one.
    pub fn bucket(&self) -> Option<&str> {
        self.store.as_deref().and_then(Path::to_str).filter(|place| place.starts_with("s3://"))
    }

    /// The store.
    ///
    /// # Errors
    /// The errors of opening it.
    pub fn open(&self) -> cosfly_diagnose::Result<Store> {
        match self.bucket() {
            Some(place) => Store::open_remote(&self.folder(), remote(place)?),
            None => Store::open(&self.folder()),
        }
    }

    /// The store, for one of many processes on a cluster. The cache of a bucket belongs to one machine.
    ///
    /// # Errors
    /// The errors of opening it.
    pub fn open_as_worker(&self) -> cosfly_diagnose::Result<Store> {
        if self.bucket().is_some() { self.open() } else { Store::open_as_worker(&self.folder()) }
    }

    /// The store, for reading.
    ///
    /// # Errors
    /// The errors of opening it.
    pub fn open_to_read(&self) -> cosfly_diagnose::Result<Store> {
        if self.bucket().is_some() { self.open() } else { Store::open_to_read(&self.folder()) }
    }

    /// The store's folder with its named versions.
    ///
    /// # Errors
    /// Those of a bucket.
    pub fn with_versions(&self) -> cosfly_diagnose::Result<PathBuf> {
        if self.bucket().is_some() {
            self.open()?.fetch_files("versions")?;
        }
        Ok(self.folder())
    }
}

/// The bucket at `place`.
///
/// # Errors
/// `remote-place`.
#[cfg(feature = "s3")]
pub fn remote(place: &str) -> cosfly_diagnose::Result<Arc<dyn Remote>> {
    Ok(Arc::new(cosfly_remote::Bucket::open(place)?))
}

/// No bucket: this program has none.
///
/// # Errors
/// `remote-unsupported`.
#[cfg(not(feature = "s3"))]
pub fn remote(place: &str) -> cosfly_diagnose::Result<Arc<dyn Remote>> {
    let message = format!("this cosfly cannot use `{place}`: it was built without buckets");
    Err(Diagnostic::new("remote-unsupported", cosfly_diagnose::Fault::Recipe, message)
        .hint("build it with `cargo build --release --features s3`, or use a folder that all machines share"))
}

/// Number of threads: what `--jobs` says, else one per core.
pub fn threads(jobs: Option<u16>) -> usize {
    jobs.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from)
}

/// Whole numbers from 1 to a million.
pub fn count() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u64).range(1..=1_000_000).map(|count| count as usize)
}

/// A file to write, whose ending says what is in it: one of `endings`, such as `png`.
pub fn file_ending_in(endings: &'static [&'static str]) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path| {
        let given = path.extension().unwrap_or_default();
        let is_right = endings.iter().any(|ending| given.eq_ignore_ascii_case(ending));
        is_right.then_some(path).ok_or_else(|| format!("the file must end in .{}", endings.join(" or .")))
    })
}

/// Machines that run the tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Place {
    /// This machine
    Local,
    /// Workers of a HyperQueue server
    Hq,
    /// None: print the commands as JSON lines
    Emit,
}

/// Tasks on other machines.
#[derive(Args, Clone, Debug)]
pub struct ClusterArguments {
    /// Machines that run the tasks; the store must be at the same place on all of them
    #[arg(long, value_name = "PLACE", value_enum, default_value_t = Place::Local)]
    pub on: Place,
    /// Resources of the tasks of a stage (* for all), such as frames:cpus=4,memory=8GB,time=2h,gpus=1,batch=1 (repeatable)
    #[arg(long, value_name = "STAGE:RESOURCES")]
    pub request: Vec<String>,
    /// Command that starts cosfly on other machines, such as "apptainer exec cosfly.sif cosfly" [default: this program's path]
    #[arg(long, value_name = "COMMAND")]
    pub leaf: Option<String>,
}

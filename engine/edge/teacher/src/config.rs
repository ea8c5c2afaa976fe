//! Parameters of a teacher.

use cosfly_diagnose::ParameterError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Place of the task in a prompt.
pub const TASK: &str = "{task}";
/// Place of the facts in a prompt.
pub const FACTS: &str = "{facts}";

/// A language model that writes texts from facts. Its answers are kept in the store; what the model wrote once is never asked
/// again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TeacherConfig {
    /// Name of the model, as the server knows it. Required.
    pub model: String,
    /// Text of a question, with `{task}` and `{facts}` in it. Default `"{task}\n\nFacts:\n{facts}"`.
    pub prompt: String,
    /// Version of the prompt, kept with every answer; questions of another version are asked anew. Default 1.
    pub prompt_version: u32,
    /// Temperature of sampling. Default 0.7.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub temperature: f64,
    /// Seed of sampling; part of every question. Default 0.
    pub seed: u64,
    /// Largest length of an answer, tokens. Default 400.
    #[schemars(range(min = 16, max = 8192))]
    pub max_tokens: u32,
    /// Form of answers that is requested of the server. Default `schema`.
    pub json: JsonMode,
    /// Pictures beside the facts; port `frames` brings them. Default `none`.
    pub frames: TeacherFrames,
    /// Number of questions about a text before it falls back to the template: the first one, and those that name a
    /// contradiction. Default 3.
    #[schemars(range(min = 1, max = 10))]
    pub attempts: u32,
    /// Raise it to ask again for lost answers; kept answers stay. Default 1.
    #[schemars(range(min = 1))]
    pub round: u32,
    /// Limit of what may be asked, over all runs on a store.
    pub budget: BudgetConfig,
    /// The server. Nothing here changes a text, and nothing here is part of a key.
    pub server: ServerConfig,
}

/// Limits of what a teacher may be asked, over all runs on a store with the same model; 0 is no limit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BudgetConfig {
    /// Number of requests, with repeated ones. Default 0.
    pub calls: u64,
    /// Number of tokens, questions and answers together. Default 0.
    pub tokens: u64,
    /// Amount of money, in the currency of the prices. Default 0.
    #[schemars(range(min = 0.0))]
    pub money: f64,
    /// Price of a million tokens of questions. Default 0.
    #[schemars(range(min = 0.0))]
    pub input_price: f64,
    /// Price of a million tokens of answers. Default 0.
    #[schemars(range(min = 0.0))]
    pub output_price: f64,
    /// Fate of texts beyond the budget. Default `stop`.
    pub when_spent: WhenSpent,
}

/// An OpenAI-compatible server, and how fast it may be asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ServerConfig {
    /// Base address, such as `http://127.0.0.1:8000/v1`; `/chat/completions` is appended. Required.
    pub address: String,
    /// Name of the environment variable that holds the key; without it no key is sent. The key itself is never written.
    pub key_variable: String,
    /// Largest number of requests at a time. Default 4.
    #[schemars(range(min = 1, max = 1024))]
    pub concurrency: u32,
    /// Largest number of requests a minute; 0 is no limit. Default 0.
    pub per_minute: u32,
    /// Time for a request and its answer, seconds. Default 60.
    #[schemars(range(min = 1.0, max = 3600.0))]
    pub timeout_s: f64,
    /// Number of repetitions of a request after 429, 5xx, a time-out or a cut answer, with growing pauses. Default 5.
    #[schemars(range(min = 0, max = 20))]
    pub retries: u32,
}

/// Form of answers that is requested of the server.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JsonMode {
    /// `response_format` with a JSON Schema: llama.cpp, vLLM, SGLang, OpenAI.
    #[default]
    Schema,
    /// `response_format` with any JSON object.
    Object,
    /// `response_format` with JSON and a key `schema`, for the server of the Python package `llama-cpp-python`.
    ObjectSchema,
    /// No `response_format`; the question still asks for JSON.
    Text,
}

/// Pictures beside the facts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TeacherFrames {
    /// No pictures.
    #[default]
    None,
    /// Four pictures, evenly over the flight, as JPEG.
    Keyframes,
    /// Eight pictures from the middle of the flight, one second apart, as JPEG.
    Clip,
}

/// Fate of texts beyond the budget.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WhenSpent {
    /// Flights without all answers fail; a run with a larger budget goes on from there.
    #[default]
    Stop,
    /// Texts of the templates, marked; a larger budget asks for them.
    Template,
}

impl Default for TeacherConfig {
    fn default() -> Self {
        Self {
            model: String::new(),
            prompt: format!("{TASK}\n\nFacts:\n{FACTS}"),
            prompt_version: 1,
            temperature: 0.7,
            seed: 0,
            max_tokens: 400,
            json: JsonMode::Schema,
            frames: TeacherFrames::None,
            attempts: 3,
            round: 1,
            budget: BudgetConfig::default(),
            server: ServerConfig::default(),
        }
    }
}

impl Default for ServerConfig {
    fn default() -> Self {
        Self {
            address: String::new(),
            key_variable: String::new(),
            concurrency: 4,
            per_minute: 0,
            timeout_s: 60.0,
            retries: 5,
        }
    }
}

impl TeacherConfig {
    /// Parameters that say where and how fast the server is asked, which changes no text; not in the key.
    pub const NOT_IN_KEY: &[&str] = &["server"];

    /// Checks what the schema cannot express.
    ///
    /// # Errors
    /// The key and the rule.
    pub fn check(&self) -> Result<(), ParameterError> {
        let refused = |path: &[&str], message: &str| {
            let path = path.iter().map(|key| (*key).to_owned()).collect();
            Err(ParameterError { path, message: message.to_owned(), hint: None })
        };
        let address = &self.server.address;
        let host = address.strip_prefix("http://").or_else(|| address.strip_prefix("https://")).unwrap_or_default();
        if self.model.trim().is_empty() {
            return refused(&["model"], "a teacher needs the name of a model");
        }
        if host.is_empty() || address.chars().any(|c| c.is_whitespace() || c.is_control()) {
            return refused(&["server", "address"], "it must be like `http://127.0.0.1:8000/v1`");
        }
        if address.contains(['@', '?', '#']) {
            return refused(
                &["server", "address"],
                "no name, key or query may be in an address: a key is in an environment variable",
            );
        }
        if !self.prompt.contains(TASK) || !self.prompt.contains(FACTS) {
            return refused(&["prompt"], "a prompt must contain `{task}` and `{facts}`");
        }
        if self.budget.money > 0.0 && self.budget.input_price + self.budget.output_price == 0.0 {
            return refused(&["budget", "money"], "a limit of money needs `input_price` and `output_price`");
        }
        Ok(())
    }
}

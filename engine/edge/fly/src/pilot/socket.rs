//! A policy behind a WebSocket that speaks openpi's wire: metadata first, then an action for every observation.

use super::answer::PolicyAnswer;
use super::manners::Manners;
use super::question::Question;
use super::seam::{Pilot, PilotFailure, late};
use crate::wire;
use cosfly_env::policies::Knowledge;
use cosfly_env::{Action, Environment};
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::error::ProtocolError;
use tungstenite::handshake::client::ClientHandshake;
use tungstenite::http::HeaderValue;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, HandshakeError, Message, WebSocket, client::client_with_config};

/// Time between attempts to connect.
const AGAIN: Duration = Duration::from_millis(200);
/// Characters of a server's text that are kept.
const KEPT: usize = 300;

/// A server.
pub struct SocketPilot {
    address: String,
    manners: Manners,
    socket: Option<WebSocket<Timed>>,
    question: Question,
    answer: Option<PolicyAnswer>,
}

/// Why there is no server.
struct NoServer {
    why: String,
    /// Whether waiting does not help.
    is_for_good: bool,
}

impl NoServer {
    fn for_now(why: impl ToString) -> Self {
        Self { why: why.to_string(), is_for_good: false }
    }

    fn for_good(why: impl ToString) -> Self {
        Self { why: why.to_string(), is_for_good: true }
    }
}

impl SocketPilot {
    /// The server at `ws://HOST:PORT`, not yet connected.
    pub fn new(address: &str, manners: Manners) -> Self {
        let question = Question::new(&manners);
        Self { address: address.to_owned(), manners, socket: None, question, answer: None }
    }

    fn connect(&self) -> Result<WebSocket<Timed>, NoServer> {
        let mut request = self.address.as_str().into_client_request().map_err(NoServer::for_good)?;
        if let Some(key) = &self.manners.api_key {
            // The text of the error would not show the key; neither does this one.
            let value = HeaderValue::from_str(&format!("Api-Key {key}"));
            let value = value.map_err(|_| NoServer::for_good("the key has characters that no header may have"))?;
            request.headers_mut().insert("Authorization", value);
        }
        let host = request.uri().host().unwrap_or("localhost").trim_matches(['[', ']']).to_owned();
        let port = request.uri().port_u16().unwrap_or(80);
        let stream = self.stream(&host, port)?;
        stream.set_nodelay(true).map_err(NoServer::for_now)?;
        let timed = Timed { stream, until: Instant::now() + self.manners.timeout };
        let limits = WebSocketConfig::default()
            .max_message_size(Some(wire::LARGEST_BYTES))
            .max_frame_size(Some(wire::LARGEST_BYTES));
        let connected = client_with_config(request, timed, Some(limits));
        connected.map(|(socket, _)| socket).map_err(|error| self.refused(error))
    }

    /// A connection to the first address of a host that takes one: `localhost` has several.
    fn stream(&self, host: &str, port: u16) -> Result<TcpStream, NoServer> {
        let mut last = NoServer::for_now(format!("`{host}` has no address"));
        for address in (host, port).to_socket_addrs().map_err(NoServer::for_now)? {
            match TcpStream::connect_timeout(&address, self.manners.timeout) {
                Ok(stream) => return Ok(stream),
                Err(error) => last = NoServer::for_now(error),
            }
        }
        Err(last)
    }

    /// Why a server does not become a WebSocket.
    fn refused(&self, error: HandshakeError<ClientHandshake<Timed>>) -> NoServer {
        let error = match error {
            HandshakeError::Interrupted(_) => {
                let timeout = self.manners.timeout.as_secs_f64();
                return NoServer::for_now(format!("the server says nothing within {timeout} s"));
            }
            HandshakeError::Failure(error) => error,
        };
        match &error {
            Error::Http(response) => {
                let status = response.status();
                let advice = match status.as_u16() {
                    300..=399 => "; redirects are not followed: give the address where the policy is",
                    401 | 403 => "; give its key with COSFLY_API_KEY or `--api-key-file`",
                    _ => "",
                };
                let why = format!("the server answers with the status {status}, not as a WebSocket{advice}");
                if status.is_server_error() { NoServer::for_now(why) } else { NoServer::for_good(why) }
            }
            Error::Io(_) | Error::ConnectionClosed | Error::Protocol(ProtocolError::HandshakeIncomplete) => {
                NoServer::for_now(error)
            }
            _ => NoServer::for_good(format!("the server does not speak as a WebSocket: {error}")),
        }
    }

    /// Waits for the server, and for its metadata.
    fn meet(&mut self) -> Result<(), String> {
        let until = Instant::now() + self.manners.wait;
        loop {
            let met = self.connect().and_then(|socket| {
                self.socket = Some(socket);
                self.metadata()
            });
            match met {
                Ok(()) => return Ok(()),
                Err(no) if no.is_for_good || Instant::now() >= until => {
                    self.socket = None;
                    let waited = self.manners.wait.as_secs_f64();
                    let waited =
                        if no.is_for_good { String::new() } else { format!(" (waited {waited} s, `--wait-s`)") };
                    let why = self.manners.beginning_of(&no.why, 2 * KEPT);
                    return Err(format!("no policy at {}: {why}{waited}", self.address));
                }
                Err(_) => std::thread::sleep(AGAIN),
            }
        }
    }

    fn metadata(&mut self) -> Result<(), NoServer> {
        let metadata = self.receive().map_err(|failure| {
            // A server that serves one episode at a time has it later.
            let is_late = self.socket.as_ref().is_some_and(|socket| socket.get_ref().left().is_err());
            match failure {
                PilotFailure::Answer(why) if !is_late => {
                    NoServer::for_good(format!("it sends no metadata first: {why}"))
                }
                PilotFailure::Answer(why) | PilotFailure::Gone(why) => {
                    NoServer::for_now(format!("it sends no metadata: {why}"))
                }
            }
        })?;
        wire::decode(&metadata).map(drop).map_err(|what| NoServer::for_good(format!("its metadata: {what}")))
    }

    /// The next message, within the time allowed.
    fn receive(&mut self) -> Result<Vec<u8>, PilotFailure> {
        let timeout = self.manners.timeout;
        let socket = self.socket.as_mut().ok_or_else(|| PilotFailure::Gone("there is no connection".to_owned()))?;
        socket.get_mut().until = Instant::now() + timeout;
        loop {
            return match socket.read() {
                Ok(Message::Binary(bytes)) => Ok(bytes.to_vec()),
                Ok(Message::Text(text)) => {
                    let text = self.manners.beginning_of(text.as_str(), KEPT);
                    Err(PilotFailure::Answer(format!("the policy answers with a text: {text}")))
                }
                Ok(Message::Ping(_) | Message::Pong(_)) => continue,
                Ok(Message::Close(_) | Message::Frame(_)) => {
                    Err(PilotFailure::Gone("the policy closed the connection".to_owned()))
                }
                Err(Error::Io(error)) if is_late(&error) => Err(PilotFailure::Answer(late(timeout))),
                Err(Error::Capacity(_)) => Err(PilotFailure::Answer(wire::too_long())),
                // It ended without a word of goodbye.
                Err(Error::Protocol(ProtocolError::ResetWithoutClosingHandshake)) => {
                    Err(PilotFailure::Gone("the policy closed the connection".to_owned()))
                }
                Err(Error::Utf8(_) | Error::Protocol(_)) => {
                    Err(PilotFailure::Answer("the answer is not a WebSocket message".to_owned()))
                }
                Err(error) => Err(PilotFailure::Gone(format!("the connection broke: {error}"))),
            };
        }
    }

    fn ask(&mut self, environment: &Environment) -> Result<PolicyAnswer, PilotFailure> {
        let question = self.question.bytes(environment);
        let socket = self.socket.as_mut().ok_or_else(|| PilotFailure::Gone("there is no connection".to_owned()))?;
        socket.get_mut().until = Instant::now() + self.manners.timeout;
        if let Err(error) = socket.send(Message::Binary(question.into())) {
            return Err(match error {
                Error::Io(error) if is_late(&error) => {
                    PilotFailure::Answer("the policy does not take the observation".to_owned())
                }
                error => PilotFailure::Gone(format!("the connection broke: {error}")),
            });
        }
        let message = self.receive()?;
        let message = wire::decode(&message).map_err(PilotFailure::Answer)?;
        PolicyAnswer::read(&message, environment, self.manners.actions).map_err(PilotFailure::Answer)
    }
}

impl Pilot for SocketPilot {
    fn begin(&mut self, _: &Environment, _: &Knowledge) -> Result<(), String> {
        // A connection of its own for every episode: nothing of the one before is left in it.
        if let Some(mut socket) = self.socket.take() {
            socket.get_mut().until = Instant::now() + AGAIN;
            _ = socket.close(None).and_then(|()| socket.flush());
        }
        self.answer = None;
        self.meet()
    }

    fn act(&mut self, environment: &Environment) -> Result<Action, PilotFailure> {
        let every = self.manners.every;
        if let Some(action) = self.answer.as_ref().and_then(|answer| answer.action(environment, every)) {
            return Ok(action);
        }
        let answer = self.ask(environment)?;
        let action = answer.action(environment, every);
        self.answer = Some(answer);
        action.ok_or_else(|| PilotFailure::Answer("the answer is too short for one step".to_owned()))
    }
}

fn is_late(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}

/// A stream whose reads and writes end at a moment, however slowly bytes come.
struct Timed {
    stream: TcpStream,
    until: Instant,
}

impl Timed {
    fn left(&self) -> io::Result<Option<Duration>> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() { Err(io::ErrorKind::TimedOut.into()) } else { Ok(Some(left)) }
    }
}

impl Read for Timed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.left()?)?;
        self.stream.read(buffer)
    }
}

impl Write for Timed {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.left()?)?;
        self.stream.write(buffer)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

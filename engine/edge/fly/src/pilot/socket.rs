//! A policy behind a WebSocket that speaks openpi's wire: metadata first, then an action for every observation.

use super::answer::Answer;
use super::question::Question;
use super::{Failure, Manners, Pilot};
use crate::wire;
use cosfly_diagnose::visible_text;
use cosfly_env::policies::Knowledge;
use cosfly_env::{Action, Environment};
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::http::HeaderValue;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket, client::client_with_config};

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
    answer: Option<Answer>,
}

impl SocketPilot {
    /// The server at `ws://HOST:PORT`, not yet connected.
    pub fn new(address: &str, manners: Manners) -> Self {
        let question = Question::new(&manners);
        Self { address: address.to_owned(), manners, socket: None, question, answer: None }
    }

    fn connect(&self) -> Result<WebSocket<Timed>, String> {
        let mut request = self.address.as_str().into_client_request().map_err(|error| error.to_string())?;
        if let Some(key) = &self.manners.api_key {
            let value = HeaderValue::from_str(&format!("Api-Key {key}"));
            request.headers_mut().insert("Authorization", value.map_err(|error| error.to_string())?);
        }
        let host = request.uri().host().unwrap_or("localhost").trim_matches(['[', ']']).to_owned();
        let port = request.uri().port_u16().unwrap_or(80);
        let mut addresses = (host.as_str(), port).to_socket_addrs().map_err(|error| error.to_string())?;
        let address = addresses.next().ok_or_else(|| format!("`{host}` has no address"))?;
        let stream = TcpStream::connect_timeout(&address, self.manners.timeout).map_err(|error| error.to_string())?;
        stream.set_nodelay(true).map_err(|error| error.to_string())?;
        let timed = Timed { stream, until: Instant::now() + self.manners.timeout };
        let limits = WebSocketConfig::default()
            .max_message_size(Some(wire::LARGEST_BYTES))
            .max_frame_size(Some(wire::LARGEST_BYTES));
        let connected = client_with_config(request, timed, Some(limits));
        connected.map(|(socket, _)| socket).map_err(|error| error.to_string())
    }

    /// Waits for the server, and for its metadata.
    fn meet(&mut self) -> Result<(), Failure> {
        let until = Instant::now() + self.manners.wait;
        loop {
            match self.connect() {
                Ok(socket) => {
                    self.socket = Some(socket);
                    break;
                }
                Err(error) if Instant::now() >= until => {
                    return Err(Failure::Gone(format!("no connection to {}: {error}", self.address)));
                }
                Err(_) => std::thread::sleep(AGAIN),
            }
        }
        let metadata = self.receive()?;
        wire::decode(&metadata).map_err(|what| Failure::Answer(format!("the metadata: {what}")))?;
        Ok(())
    }

    /// The next message, within the time allowed.
    fn receive(&mut self) -> Result<Vec<u8>, Failure> {
        let timeout = self.manners.timeout;
        let socket = self.socket.as_mut().ok_or_else(|| Failure::Gone("there is no connection".to_owned()))?;
        socket.get_mut().until = Instant::now() + timeout;
        loop {
            return match socket.read() {
                Ok(Message::Binary(bytes)) => Ok(bytes.to_vec()),
                Ok(Message::Text(text)) => {
                    let text: String = visible_text(text.as_str()).chars().take(KEPT).collect();
                    Err(Failure::Answer(format!("the policy answers with a text: {text}")))
                }
                Ok(Message::Ping(_) | Message::Pong(_)) => continue,
                Ok(Message::Close(_) | Message::Frame(_)) => {
                    Err(Failure::Gone("the policy closed the connection".to_owned()))
                }
                Err(Error::Io(error)) if is_late(&error) => {
                    Err(Failure::Answer(format!("no answer within {} s", timeout.as_secs_f64())))
                }
                Err(Error::Capacity(_)) => {
                    Err(Failure::Answer(format!("the answer is longer than {} MiB", wire::LARGEST_BYTES >> 20)))
                }
                Err(Error::Utf8(_) | Error::Protocol(tungstenite::error::ProtocolError::InvalidOpcode(_))) => {
                    Err(Failure::Answer("the answer is not a WebSocket message".to_owned()))
                }
                Err(error) => Err(Failure::Gone(format!("the connection broke: {error}"))),
            };
        }
    }

    fn ask(&mut self, environment: &Environment) -> Result<Answer, Failure> {
        let question = self.question.bytes(environment);
        let socket = self.socket.as_mut().ok_or_else(|| Failure::Gone("there is no connection".to_owned()))?;
        socket.get_mut().until = Instant::now() + self.manners.timeout;
        if let Err(error) = socket.send(Message::Binary(question.into())) {
            return Err(match error {
                Error::Io(error) if is_late(&error) => {
                    Failure::Answer("the policy does not take the observation".to_owned())
                }
                error => Failure::Gone(format!("the connection broke: {error}")),
            });
        }
        let message = self.receive()?;
        let message = wire::decode(&message).map_err(Failure::Answer)?;
        Answer::read(&message, environment, self.manners.actions).map_err(Failure::Answer)
    }
}

impl Pilot for SocketPilot {
    fn begin(&mut self, _: &Environment, _: &Knowledge) -> Result<(), Failure> {
        // A connection of its own for every episode: nothing of the one before is left in it.
        if let Some(mut socket) = self.socket.take() {
            socket.get_mut().until = Instant::now() + AGAIN;
            _ = socket.close(None).and_then(|()| socket.flush());
        }
        self.answer = None;
        self.meet()
    }

    fn act(&mut self, environment: &Environment) -> Result<Action, Failure> {
        let every = self.manners.every;
        if let Some(action) = self.answer.as_ref().and_then(|answer| answer.action(environment, every)) {
            return Ok(action);
        }
        let answer = self.ask(environment)?;
        let action = answer.action(environment, every);
        self.answer = Some(answer);
        action.ok_or_else(|| Failure::Answer("the answer is too short for one step".to_owned()))
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

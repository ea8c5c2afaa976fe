//! Connections: each on a thread, few at a time, all with limits of time.

use super::gate::{Caller, Gate};
use super::request::{NoRequest, Request};
use super::response::Response;
use crate::routes::answer;
use crate::subject::ViewSubject;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::io::{ErrorKind, Read};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

/// Most connections at a time; a browser opens six.
const MOST_CONNECTIONS: usize = 32;
/// Most requests of a connection.
const MOST_REQUESTS: usize = 10_000;
/// Pause between two looks for a connection.
const LOOK: Duration = Duration::from_millis(5);
/// Time after which a read looks whether the server stops.
const READ: Duration = Duration::from_millis(200);
/// Parts of 4 kB that are taken from a connection that ends.
const MOST_PARTS: usize = 16;
/// Time within which a browser must take a part of an answer.
const WRITE: Duration = Duration::from_secs(10);

/// A server on the loopback interface.
pub struct Server {
    listener: TcpListener,
    gate: Gate,
}

impl Server {
    /// Takes a port; 0 for a free one.
    ///
    /// # Errors
    /// `view-port`.
    pub fn bind(port: u16) -> Result<Self> {
        let refused = |error: std::io::Error| {
            let message = format!("port {port} of 127.0.0.1 cannot be used");
            let refusal = Diagnostic::new("view-port", Fault::Machine, message).because(error);
            refusal.hint("leave `--port` out for a free one")
        };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(refused)?;
        listener.set_nonblocking(true).map_err(refused)?;
        let port = listener.local_addr().map_err(refused)?.port();
        Ok(Self { listener, gate: Gate::new(port) })
    }

    /// The address that opens the page, once.
    pub fn address(&self) -> String {
        self.gate.address()
    }

    /// Answers requests until `stop` is set.
    pub fn serve(&self, subject: &dyn ViewSubject, stop: &AtomicBool) {
        let open = AtomicUsize::new(0);
        std::thread::scope(|scope| {
            while !stop.load(Ordering::SeqCst) {
                match self.listener.accept() {
                    Ok((stream, _)) if open.load(Ordering::SeqCst) < MOST_CONNECTIONS => {
                        let open = &open;
                        open.fetch_add(1, Ordering::SeqCst);
                        scope.spawn(move || {
                            self.attend(&stream, subject, stop);
                            open.fetch_sub(1, Ordering::SeqCst);
                        });
                    }
                    Ok((stream, _)) => {
                        _ = stream.set_write_timeout(Some(READ));
                        _ = Response::refusal(503, "too many connections").write(&mut &stream, false, false);
                        // What has come is taken; nobody waits for more.
                        _ = stream.set_nonblocking(true);
                        end(&stream);
                    }
                    Err(error) if error.kind() == ErrorKind::WouldBlock => std::thread::sleep(LOOK),
                    // Such as too many open files: others end meanwhile.
                    Err(_) => std::thread::sleep(READ),
                }
            }
        });
    }

    /// Answers the requests of a connection.
    fn attend(&self, stream: &TcpStream, subject: &dyn ViewSubject, stop: &AtomicBool) {
        let is_set = stream.set_nonblocking(false).is_ok()
            && stream.set_read_timeout(Some(READ)).is_ok()
            && stream.set_write_timeout(Some(WRITE)).is_ok()
            && stream.set_nodelay(true).is_ok();
        if !is_set {
            return;
        }
        let (mut rest, is_stopped) = (vec![], || stop.load(Ordering::SeqCst));
        for left in (0..MOST_REQUESTS).rev() {
            let (response, is_head, stays) = match Request::read(&mut &*stream, &mut rest, &is_stopped) {
                Ok(request) => (self.response(&request, subject), request.is_head, left > 0 && !closes(&request)),
                Err(NoRequest::Refused(status, words)) => (Response::refusal(status, words), false, false),
                Err(NoRequest::Over) => return,
            };
            if response.write(&mut &*stream, is_head, stays).is_err() {
                return;
            }
            if !stays {
                return end(stream);
            }
        }
    }

    fn response(&self, request: &Request, subject: &dyn ViewSubject) -> Response {
        match self.gate.check(request) {
            Ok(Caller::Known) => answer(request, subject),
            Ok(Caller::New(cookie)) => answer(request, subject).with_cookie(cookie),
            Err(refusal) => refusal,
        }
    }
}

/// Ends a connection so that its answer arrives: a few bytes that were still sent are taken, otherwise they would reset it.
fn end(mut stream: &TcpStream) {
    _ = stream.shutdown(Shutdown::Write);
    let mut part = [0; 4096];
    for _ in 0..MOST_PARTS {
        if !matches!(stream.read(&mut part), Ok(1..)) {
            return;
        }
    }
}

fn closes(request: &Request) -> bool {
    request.header("connection").is_some_and(|words| words.eq_ignore_ascii_case("close"))
}

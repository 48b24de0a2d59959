//! A door in front of a broker.

use std::io::copy;
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// Forwards connections to a broker while it is open. So a test decides when a client can reach the broker.
pub(crate) struct Gate {
    pub(crate) address: SocketAddr,
    is_open: Arc<AtomicBool>,
    connections: Arc<Mutex<Vec<TcpStream>>>,
}

impl Gate {
    pub(crate) fn before(broker: SocketAddr) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let (is_open, connections) = (Arc::new(AtomicBool::new(true)), Arc::<Mutex<Vec<TcpStream>>>::default());
        let (own_open, own_connections) = (Arc::clone(&is_open), Arc::clone(&connections));
        std::thread::spawn(move || {
            for client in listener.incoming().map_while(Result::ok) {
                let mut connections = own_connections.lock().unwrap();
                if own_open.load(Ordering::SeqCst)
                    && let Ok(server) = TcpStream::connect(broker)
                {
                    connections.extend([client.try_clone().unwrap(), server.try_clone().unwrap()]);
                    forward(client.try_clone().unwrap(), server.try_clone().unwrap());
                    forward(server, client);
                }
            }
        });
        Self { address, is_open, connections }
    }

    pub(crate) fn open(&self) {
        self.is_open.store(true, Ordering::SeqCst);
    }

    /// Ends all connections, and refuses new ones.
    pub(crate) fn close(&self) {
        // The lock waits for a connection that is made now.
        let mut connections = self.connections.lock().unwrap();
        self.is_open.store(false, Ordering::SeqCst);
        for connection in connections.drain(..) {
            let _ = connection.shutdown(Shutdown::Both);
        }
    }
}

fn forward(mut from: TcpStream, mut to: TcpStream) {
    std::thread::spawn(move || {
        let _ = copy(&mut from, &mut to);
        let _ = from.shutdown(Shutdown::Both);
        let _ = to.shutdown(Shutdown::Both);
    });
}

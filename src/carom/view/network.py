"""Where a view listens, and under which addresses it is reached."""

import errno
import ipaddress
import socket

from carom.errors import FileError, InputError

LOOPBACK = ("127.0.0.1", "localhost")
EVERYWHERE = "0.0.0.0"


def checked_port(port: object) -> int:
    """`port`, if it is one.

    Raises
    ------
    InputError
        If not.
    """
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port <= 65535:
        msg = f"port is {port!r}; it must be a whole number from 0 (any free one) to 65535"
        raise InputError(msg)
    return port


def is_loopback(host: str) -> bool:
    """Whether only this machine reaches a view that listens at `host`."""
    return host in LOOPBACK or ipaddress.IPv4Address(host).is_loopback


def listen(host: str, port: int) -> socket.socket:
    """Open a listening socket.

    Raises
    ------
    FileError
        If the port or the address cannot be used.
    """
    address = "127.0.0.1" if host == "localhost" else host
    try:
        return socket.create_server((address, port))
    except OSError as error:
        if error.errno == errno.EADDRNOTAVAIL:
            msg = (
                f"{host} is no address of this machine; give one of {', '.join(own_addresses())}, "
                f"or {EVERYWHERE} for all of them"
            )
            raise FileError(msg) from error
        why = "is in use" if error.errno == errno.EADDRINUSE else f"cannot be used ({error})"
        msg = f"port {port} {why}; choose another, or 0 for any free one"
        raise FileError(msg) from error


def reached_as(host: str) -> tuple[str, ...]:
    """Names and addresses by which a view that listens at `host` is reached, the best first.

    Raises
    ------
    InputError
        If `host` is no IPv4 address of a machine.
    """
    if host in LOOPBACK:
        return (host, *(name for name in LOOPBACK if name != host))
    try:
        address = ipaddress.IPv4Address(host)
    except ValueError:
        address = None
    # Nobody can open the address of a group of machines, though one may listen at it.
    if address is None or address.is_multicast or address.is_reserved:
        msg = (
            f"host is {host!r}; give an address of this machine such as {own_addresses()[0]}, "
            f"{EVERYWHERE} for all of them, or 127.0.0.1 for this machine alone"
        )
        raise InputError(msg)
    if host == EVERYWHERE:
        return (*own_addresses(), *LOOPBACK)
    return (host,)


def own_addresses() -> list[str]:
    """IPv4 addresses of this machine that others can reach; its loopback if there are none."""
    found = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            # Connecting a datagram socket sends nothing: it asks the routing table alone.
            probe.connect(("192.0.2.1", 9))
            found.append(str(probe.getsockname()[0]))
        except OSError:
            pass
    try:
        rows = socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)
        found += [str(row[4][0]) for row in rows]
    except OSError:
        pass
    outside = [address for address in dict.fromkeys(found) if not address.startswith("127.")]
    return outside or ["127.0.0.1"]

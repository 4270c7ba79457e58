/** The live view's page. */
import { Connection, takeToken } from "./connection.js";
import { readLink } from "./link.js";
import { Page } from "./page.js";
import { startPage } from "./start.js";

const wanted = readLink(location.hash);
const token = takeToken();
void startPage(() => new Page({ mode: "live", token, wanted, connect: (listener) => new Connection(token, listener) }));

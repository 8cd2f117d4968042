// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads an MCAP file with the libraries that Foxglove uses, by its index and as a stream with all
// checksums; prints what it found as JSON: read_mcap.mjs FILE
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import * as schemas from "@foxglove/schemas/jsonschema.js";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { readFile } from "node:fs/promises";

const bytes = await readFile(process.argv[2]);
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
};
const reader = await McapIndexedReader.Initialize({ readable });
const messages = [];
const decoders = new Map();
const text = (data) => new TextDecoder().decode(data);

// Of a schema with a name of Foxglove's: what differs from theirs, of which it has the required part at least.
function difference(ours, theirs, path) {
  for (const key of ["type", "title", "contentEncoding"])
    if (ours[key] !== undefined && theirs[key] !== undefined && ours[key] !== theirs[key]) return `${path}: ${key}`;
  if (theirs.contentEncoding !== ours.contentEncoding) return `${path}: contentEncoding`;
  if (theirs.items) return difference(ours.items ?? {}, theirs.items, `${path}[]`);
  for (const name of theirs.required ?? []) if (!ours.properties?.[name]) return `${path}: no ${name}`;
  for (const [name, inner] of Object.entries(ours.properties ?? {})) {
    const found = theirs.properties?.[name] ? difference(inner, theirs.properties[name], `${path}.${name}`) : `${path}: ${name}`;
    if (found) return found;
  }
}

function decoderOf({ name, encoding, data }) {
  if (encoding === "jsonschema") {
    const found = name.startsWith("foxglove.") && difference(JSON.parse(text(data)), schemas[name.slice(9)], name);
    if (found) throw new Error(`not Foxglove's schema: ${found}`);
    return (bytes) => JSON.parse(text(bytes));
  }
  const ros2 = new MessageReader(parse(text(data), { ros2: true }));
  return (bytes) => ros2.readMessage(bytes);
}

// Typed arrays as arrays; times as they are named in ROS 2.
const plain = (_, value) => ArrayBuffer.isView(value) ? [...value]
  : profile === "ros2" && value?.nsec !== undefined ? { sec: value.sec, nanosec: value.nsec } : value;

for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  if (!decoders.has(schema.id)) decoders.set(schema.id, decoderOf(schema));
  messages.push({
    topic: channel.topic,
    schema: schema.name,
    sequence: message.sequence,
    log_time: String(message.logTime),
    data: decoders.get(schema.id)(message.data),
  });
}
const stream = new McapStreamReader({ validateCrcs: true });
stream.append(bytes);
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message" ? 1 : 0;
const statistics = Number(reader.statistics.messageCount);
const { profile } = reader.header;
console.log(JSON.stringify({ profile, messages, streamed: stream.done() ? streamed : -1, statistics }, plain));

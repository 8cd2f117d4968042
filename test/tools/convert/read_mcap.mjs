// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads an MCAP file with the libraries that Foxglove uses, by its index and as a stream with all
// checksums; prints what it found as JSON: read_mcap.mjs FILE
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
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

function decoderOf({ encoding, data }) {
  if (encoding === "jsonschema") return (bytes) => JSON.parse(text(bytes));
  const ros2 = new MessageReader(parse(text(data), { ros2: true }));
  return (bytes) => ros2.readMessage(bytes);
}

// Typed arrays as arrays; times as they are named in ROS 2.
const plain = (_, value) => ArrayBuffer.isView(value) ? [...value]
  : value?.nsec !== undefined ? { sec: value.sec, nanosec: value.nsec } : value;

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

// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads an MCAP file with the library that Foxglove uses, by its index and as a stream with all
// checksums; prints what it found as JSON: read_mcap.mjs FILE
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { readFile } from "node:fs/promises";

const bytes = await readFile(process.argv[2]);
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
};
const reader = await McapIndexedReader.Initialize({ readable });
const messages = [];
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  messages.push({
    topic: channel.topic,
    schema: reader.schemasById.get(channel.schemaId).name,
    sequence: message.sequence,
    log_time: String(message.logTime),
    data: JSON.parse(new TextDecoder().decode(message.data)),
  });
}
const stream = new McapStreamReader({ validateCrcs: true });
stream.append(bytes);
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message" ? 1 : 0;
const statistics = Number(reader.statistics.messageCount);
console.log(JSON.stringify({ messages, streamed: stream.done() ? streamed : -1, statistics }));

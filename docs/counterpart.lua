-- Wireshark dissector for the Counterpart protocol, version 1 (docs/protocol.md).
--   wireshark -X lua_script:counterpart.lua
--   tshark -X lua_script:counterpart.lua -r session.pcap -Y counterpart
local counterpart = Proto("counterpart", "Counterpart Protocol")

local types = {
  [1] = "HELLO", [2] = "WELCOME", [3] = "HEARTBEAT", [4] = "ERROR", [5] = "BYE", [6] = "CLOCK_REQUEST",
  [7] = "CLOCK_RESPONSE", [8] = "ACKNOWLEDGE", [9] = "CHALLENGE", [10] = "PROOF", [16] = "INTRINSICS", [17] = "POSE",
  [18] = "VIDEO", [19] = "MASK", [20] = "DEBUG", [21] = "FRAME_DONE", [32] = "BOARD_STATE", [33] = "GAME_EVENT",
  [34] = "CONTROL", [35] = "SCENE", [48] = "COMMAND", [49] = "FEEDBACK",
}
local fixed = { [3] = true, [6] = true, [7] = true, [8] = true, [17] = true, [18] = true, [19] = true, [21] = true }
local status = { [1] = "ok", [2] = "coasting", [3] = "lost", [4] = "relocalised" }
local codecs = { [1] = "raw BGR", [2] = "JPEG", [3] = "H.264" }

local f = {
  type = ProtoField.uint16("counterpart.type", "Type", base.DEC, types),
  version = ProtoField.uint8("counterpart.type_version", "Type version"),
  kept = ProtoField.bool("counterpart.kept", "Kept", 8, nil, 1),
  length = ProtoField.uint32("counterpart.length", "Length"),
  crc = ProtoField.uint32("counterpart.crc", "CRC32C", base.HEX),
  session = ProtoField.uint64("counterpart.session", "Session", base.HEX),
  seq = ProtoField.uint64("counterpart.seq", "Sequence number"),
  frame_id = ProtoField.uint64("counterpart.frame_id", "Frame"),
  time = ProtoField.int64("counterpart.time", "Sender's time (ns)"),
  json = ProtoField.string("counterpart.json", "JSON", base.UNICODE),
  capture_ns = ProtoField.int64("counterpart.capture_ns", "Captured (ns)"),
  status = ProtoField.uint8("counterpart.pose.status", "Status", base.DEC, status),
  rms = ProtoField.float("counterpart.pose.rms_px", "RMS (px)"),
  qw = ProtoField.double("counterpart.pose.qw", "q w"), qx = ProtoField.double("counterpart.pose.qx", "q x"),
  qy = ProtoField.double("counterpart.pose.qy", "q y"), qz = ProtoField.double("counterpart.pose.qz", "q z"),
  tx = ProtoField.double("counterpart.pose.tx", "x (m)"), ty = ProtoField.double("counterpart.pose.ty", "y (m)"),
  tz = ProtoField.double("counterpart.pose.tz", "z (m)"),
  codec = ProtoField.uint16("counterpart.video.codec", "Codec", base.DEC, codecs),
  width = ProtoField.uint16("counterpart.width", "Width"), height = ProtoField.uint16("counterpart.height", "Height"),
  acknowledged = ProtoField.uint64("counterpart.acknowledged", "Acknowledged up to"),
  queued = ProtoField.uint32("counterpart.queued", "Queued"), dropped = ProtoField.uint64("counterpart.dropped", "Dropped"),
  body = ProtoField.bytes("counterpart.body", "Body"),
}
counterpart.fields = f

local header_size = 48

local function body_of(number, body, tree)
  if not fixed[number] then
    tree:add(f.json, body)
  elseif number == 3 and body:len() >= 16 then
    tree:add_le(f.queued, body(0, 4))
    tree:add_le(f.dropped, body(8, 8))
  elseif number == 8 and body:len() >= 8 then
    tree:add_le(f.acknowledged, body(0, 8))
  elseif number == 17 and body:len() >= 180 then
    tree:add_le(f.capture_ns, body(8, 8))
    tree:add_le(f.status, body(24, 1))
    tree:add_le(f.rms, body(28, 4))
    local at = 40
    for _, field in ipairs({ f.qw, f.qx, f.qy, f.qz, f.tx, f.ty, f.tz }) do
      tree:add_le(field, body(at, 8))
      at = at + 8
    end
  elseif number == 18 and body:len() >= 32 then
    tree:add_le(f.capture_ns, body(8, 8))
    tree:add_le(f.codec, body(16, 2))
    tree:add_le(f.width, body(18, 2))
    tree:add_le(f.height, body(20, 2))
  else
    tree:add(f.body, body)
  end
end

local function message_length(buffer, _, offset)
  return header_size + buffer(offset + 8, 4):le_uint()
end

local function message(buffer, info, tree)
  local number = buffer(4, 2):le_uint()
  local name = types[number] or ("type " .. number)
  local branch = tree:add(counterpart, buffer(), "Counterpart " .. name)
  branch:add_le(f.type, buffer(4, 2))
  branch:add_le(f.version, buffer(6, 1))
  branch:add_le(f.kept, buffer(7, 1))
  branch:add_le(f.length, buffer(8, 4))
  branch:add_le(f.crc, buffer(12, 4))
  branch:add_le(f.session, buffer(16, 8))
  branch:add_le(f.seq, buffer(24, 8))
  branch:add_le(f.frame_id, buffer(32, 8))
  branch:add_le(f.time, buffer(40, 8))
  if buffer:len() > header_size then body_of(number, buffer(header_size), branch) end
  info.cols.protocol = "VHP1"
  info.cols.info:append(" " .. name)
  return buffer:len()
end

function counterpart.dissector(buffer, info, tree)
  if buffer:len() >= 4 and buffer(0, 4):string() ~= "VHP1" then return 0 end
  info.cols.info:clear()
  dissect_tcp_pdus(buffer, tree, header_size, message_length, message)
  return buffer:len()
end

local function looks_right(buffer, info, tree)
  if buffer:len() < header_size or buffer(0, 4):string() ~= "VHP1" then return false end
  info.conversation = counterpart
  counterpart.dissector(buffer, info, tree)
  return true
end
counterpart:register_heuristic("tcp", looks_right)
for _, port in ipairs({ 7401, 7402, 7403 }) do DissectorTable.get("tcp.port"):add(port, counterpart) end

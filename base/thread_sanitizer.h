// Include once in every program's file that talks to ZeroMQ: tells ThreadSanitizer that libzmq and libsodium,
// which are not built with it and hand memory between libzmq's threads by its own atomics, are not at fault.
// Received bytes are read by message_t::to_string alone, whose reports name no libzmq frame when the writing
// thread's stack is forgotten already. The same of libprotobuf, which makes its empty set of unknown fields
// at its first use, behind a guard that only an instrumented build would show. Races in our own code are
// reported as ever. Nothing at all in other builds.
#pragma once

#if defined(__SANITIZE_THREAD__)
extern "C" __attribute__((weak, used, visibility("default"))) const char* __tsan_default_suppressions();
// Looked up by name when the program starts; weak, because several files of one program may include this.
extern "C" const char* __tsan_default_suppressions() {
  return "called_from_lib:libzmq.so\nrace:libzmq.so\nrace:libsodium.so\n"
         "race:zmq::message_t::to_string\nrace:google::protobuf::UnknownFieldSet\n";
}
#endif

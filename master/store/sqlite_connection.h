// A thin RAII layer over SQLite's C interface: errors as values, nothing else added.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace gauntlet {

// Bytes for a column that is no text.
struct Blob {
  std::string_view bytes;
};

// A prepared statement. Unsigned values travel as the bits of
// SQLite's signed 64-bit integer. Must not outlive its connection.
class SqliteStatement {
 public:
  SqliteStatement() = default;

  // Gives the parameters their values, the first one first: numbers, texts, Blobs; NaN becomes NULL, for
  // SQLite has no NaN. Texts and blobs must live until Reset().
  template <typename... Values>
  void Bind(const Values&... values) {
    int index = 0;
    (BindOne(index++, values), ...);
  }

  // True when there is a row to read, false at the end. The first failed Bind is reported here.
  Result<bool> Step();
  // Calls visit() for every row that is left, until it answers with an error.
  template <typename Visit>
  Status ForEachRow(const Visit& visit) {
    while (true) {
      TRY(bool row, Step());
      if (!row) return Ok{};
      TRY(visit());
    }
  }
  // Steps a statement that returns no rows, with these values, and resets it whatever came of it.
  template <typename... Values>
  Status Run(const Values&... values) {
    Bind(values...);
    Result<bool> stepped = Step();
    Reset();
    if (!stepped) return stepped.error();
    return Ok{};
  }
  // Makes it ready to be bound and stepped again.
  void Reset();

  // Sets the members from the row's columns, the first one first: numbers from integers, strings from texts
  // or blobs.
  template <typename... Members>
  void Read(Members&... members) const {
    int column = 0;
    (ReadOne(column++, members), ...);
  }

 private:
  friend class SqliteConnection;
  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const;
  };

  template <std::integral Number>
  void BindOne(int index, Number value) {
    BindInt(index, static_cast<std::int64_t>(value));
  }
  void BindOne(int index, double value);
  void BindOne(int index, std::string_view text);
  void BindOne(int index, Blob blob);
  void BindInt(int index, std::int64_t value);
  template <std::integral Number>
  void ReadOne(int column, Number& number) const {
    number = static_cast<Number>(Int(column));
  }
  void ReadOne(int column, std::string& bytes) const;
  std::int64_t Int(int column) const;
  void Remember(int code);

  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
  int bind_error_ = 0;
};

// One open database. Not thread-safe: whoever shares it between threads holds a mutex around every use, that
// of its statements included.
class SqliteConnection {
 public:
  enum class Mode {
    kReadOnly,
    kReadWrite,  // the file must exist
    kCreate,     // makes the file when it does not exist
  };

  SqliteConnection() = default;

  // `file` is a path or a `file:` URI. `vfs` names a registered SQLite VFS, "" = the default one. Nothing is
  // read from the file before the first statement.
  static Result<SqliteConnection> Open(const std::string& file, Mode mode, const std::string& vfs = "");

  // Runs statements whose rows, if any, nobody wants.
  Status Execute(const std::string& sql);
  Result<SqliteStatement> Prepare(std::string_view sql);
  // The single integer that a query (a PRAGMA, mostly) answers with; kCorrupt when it answers with none.
  Result<std::int64_t> QueryInt(std::string_view sql);

  // Ends what another thread does with this connection: it answers with an error (kInternal). The one
  // function that any thread may call; the connection must not be closed meanwhile.
  void Interrupt() const;

  // Rows that the last INSERT added: 0 when it met ON CONFLICT DO NOTHING.
  int Changes() const;
  // When off, closing the connection leaves the write-ahead log as it is; SQLite's default is to move it into
  // the database and delete it.
  void CheckpointOnClose(bool on);

 private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };

  std::unique_ptr<sqlite3, Closer> database_;
};

// A `file:` URI of a path, for query parameters such as "immutable=1".
std::string SqliteUri(const std::string& path, std::string_view parameters);

}  // namespace gauntlet

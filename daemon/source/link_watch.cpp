// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/link_watch.hpp"

#include <algorithm>
#include <cerrno>

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/socket.h>

namespace cremed {
namespace {

/// The largest message of the kernel (netlink(7)).
constexpr std::size_t kBufferBytes = 32768;
/// Far more links than any vehicle has; the rest stays queued.
constexpr int kMaxReads = 1000;
/// Reserved capacity, so that a new link seldom allocates.
constexpr std::size_t kUsualLinks = 64;

const ifinfomsg* info_in(const nlmsghdr& header) {
  return reinterpret_cast<const ifinfomsg*>(reinterpret_cast<const char*>(&header) + NLMSG_HDRLEN);
}

std::string_view name_in(const nlmsghdr& header) {
  const ifinfomsg* const info = info_in(header);
  auto size = static_cast<int>(IFLA_PAYLOAD(&header));
  for (const rtattr* attribute = IFLA_RTA(info); RTA_OK(attribute, size);
       attribute = RTA_NEXT(attribute, size)) {
    if (attribute->rta_type == IFLA_IFNAME) {
      const std::string_view text(static_cast<const char*>(RTA_DATA(attribute)),
                                  RTA_PAYLOAD(attribute));
      return text.substr(0, text.find('\0'));
    }
  }
  return {};
}

}  // namespace

LinkWatch::LinkWatch() : buffer_(kBufferBytes) {
  links_.reserve(kUsualLinks);
  update();
}

void LinkWatch::open() {
  descriptor_ =
      Descriptor(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_ROUTE));
  sockaddr_nl address{};
  address.nl_family = AF_NETLINK;
  address.nl_groups = RTMGRP_LINK;
  if (!descriptor_.is_open() ||
      ::bind(descriptor_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) !=
          0) {
    fail();
    return;
  }
  request_all();
}

/// Requests the state of all links: at the start, and after lost notifications.
void LinkWatch::request_all() {
  links_.clear();
  error_ = 0;
  struct {
    nlmsghdr header;
    ifinfomsg info;
  } request{};
  request.header.nlmsg_len = sizeof(request);
  request.header.nlmsg_type = RTM_GETLINK;
  request.header.nlmsg_flags = NLM_F_REQUEST | NLM_F_DUMP;
  if (::send(descriptor_.number(), &request, sizeof(request), 0) != sizeof(request)) {
    fail();
  }
}

void LinkWatch::fail() {
  error_ = errno;
  descriptor_ = Descriptor();
  links_.clear();
}

void LinkWatch::update() {
  if (!descriptor_.is_open()) {
    open();
  }
  for (int i = 0; i < kMaxReads && descriptor_.is_open(); ++i) {
    sockaddr_nl sender{};
    socklen_t sender_size = sizeof(sender);
    const ssize_t size = ::recvfrom(descriptor_.number(), buffer_.data(), buffer_.size(), 0,
                                    reinterpret_cast<sockaddr*>(&sender), &sender_size);
    if (size >= 0) {
      if (sender.nl_pid == 0) {  // From the kernel, not another process.
        take(buffer_.data(), static_cast<std::size_t>(size));
      }
    } else if (errno == ENOBUFS) {
      request_all();
    } else if (errno != EINTR) {
      if (errno != EAGAIN) {
        fail();
      }
      return;
    }
  }
}

void LinkWatch::take(const char* messages, std::size_t size) {
  auto left = static_cast<unsigned>(size);
  for (const auto* header = reinterpret_cast<const nlmsghdr*>(messages); NLMSG_OK(header, left);
       header = NLMSG_NEXT(header, left)) {
    if (header->nlmsg_type == RTM_NEWLINK || header->nlmsg_type == RTM_DELLINK) {
      const ifinfomsg* const info = info_in(*header);
      note({std::string(name_in(*header)),
            {.index = static_cast<unsigned>(info->ifi_index),
             .is_up = (info->ifi_flags & IFF_UP) != 0,
             .is_can = info->ifi_type == ARPHRD_CAN,
             .has_carrier = (info->ifi_flags & IFF_RUNNING) != 0}},
           header->nlmsg_type == RTM_NEWLINK);
    }
  }
}

void LinkWatch::note(const NamedLink& link, bool is_there) {
  std::erase_if(links_, [&](const NamedLink& known) {
    return known.link.index == link.link.index || (is_there && known.name == link.name);
  });
  if (is_there) {
    links_.push_back(link);
  }
}

Link LinkWatch::link(std::string_view name) const {
  const auto found = std::ranges::find(links_, name, &NamedLink::name);
  return found == links_.end() ? Link{.error = error_} : found->link;
}

std::vector<std::string> LinkWatch::can_names() const {
  std::vector<std::string> names;
  for (const NamedLink& link : links_) {
    if (link.link.is_can) {
      names.push_back(link.name);
    }
  }
  return names;
}

}  // namespace cremed
